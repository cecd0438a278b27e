"""Journeys by an emulator of the touchdowns of a study's journeys: beside these, and at every delivery option."""
