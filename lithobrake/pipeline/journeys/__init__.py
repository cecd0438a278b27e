"""Journeys: each lander is followed from its delivery to rest, with a simulated landing at every impact."""
