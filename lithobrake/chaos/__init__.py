"""Polynomial chaos for any model: inputs with distributions, designs, fits, moments, sensitivity indices."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
