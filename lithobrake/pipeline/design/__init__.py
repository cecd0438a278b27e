"""What a study asks for: the runs that it draws, what they depend on, and their keys."""
