"""The method of the paper: polynomial chaos expansions of the first touchdown, and samples by them."""
