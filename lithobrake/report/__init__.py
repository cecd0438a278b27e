"""The report of a study: reads the files of its folder, draws the figures, writes one page. Computes nothing new."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
