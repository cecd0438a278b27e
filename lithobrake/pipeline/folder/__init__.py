"""The folder of a study: its files, which of them are current, whose it is."""
