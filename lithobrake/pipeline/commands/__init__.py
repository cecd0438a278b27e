"""What one command of the command line does beside running a study, a file each."""
