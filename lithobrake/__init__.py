"""Predict where a lander comes to rest on a small body whose soil is unknown, with confidence intervals."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__version__ = "0.1.0"
__all__ = ["Study", "StudyResults", "__version__", "open_study", "run"]
