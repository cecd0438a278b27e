"""The emulator of the first touchdown, and hard ground that is equivalent to the soil."""
