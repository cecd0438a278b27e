"""Studies of first bounces: the emulator of drawn runs, and journeys that go on by it."""
