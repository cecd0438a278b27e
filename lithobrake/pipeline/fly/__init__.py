"""Flights of landings and samples to the next impact."""
