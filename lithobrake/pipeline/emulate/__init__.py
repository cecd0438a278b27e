"""The emulator of a study, and its samples."""
