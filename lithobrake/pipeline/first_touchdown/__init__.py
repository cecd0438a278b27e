"""The first touchdown: its emulator, samples of it, and the flights after it."""
