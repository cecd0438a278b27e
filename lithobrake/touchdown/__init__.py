"""Pour and settle a bed, place a lander, run one landing, give its outcome."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
