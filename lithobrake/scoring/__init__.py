"""Scores of predicted landings against what was observed, and the archive of past landings."""

from lithobrake.scoring.landing_scores import LandingScore, scores
from lithobrake.scoring.observed_landing import ObservedLanding, archive, past_landing, read_observation
from lithobrake.scoring.predicted_landings import PredictedLandings, read_prediction
from lithobrake.scoring.proper_scores import crps, energy_score, log_score

__all__ = [
    "LandingScore",
    "ObservedLanding",
    "PredictedLandings",
    "archive",
    "crps",
    "energy_score",
    "log_score",
    "past_landing",
    "read_observation",
    "read_prediction",
    "scores",
]
