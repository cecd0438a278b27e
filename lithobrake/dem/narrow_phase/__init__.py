"""Where two touch: closest points of convex cores, the features near them, and the patch of points with one energy."""
