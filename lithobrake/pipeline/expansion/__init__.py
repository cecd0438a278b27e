"""Polynomial chaos expansions of the first touchdown, and samples by them. Source: [Landings-PCE]."""
