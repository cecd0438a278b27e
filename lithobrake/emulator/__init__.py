"""Conditional distributions of any stochastic model, from its runs: fit, draw, score, save. Stands on chaos alone."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
