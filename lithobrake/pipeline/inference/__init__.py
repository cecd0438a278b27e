"""The soil inferred from observed bounces, by the emulator of a study."""
