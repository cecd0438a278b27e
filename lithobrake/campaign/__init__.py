"""Many runs of any model: each is computed once, kept in a ledger the moment it ends, and never lost."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
