"""Journeys from bounce to bounce until the lander rests."""
