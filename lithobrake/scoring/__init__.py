"""Scores of predicted landings against what was observed."""
