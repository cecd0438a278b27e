"""Small bodies: shape, gravity, rotation, flight, and landers that are followed over them."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
