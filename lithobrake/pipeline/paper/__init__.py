"""The published method: polynomial chaos at one impact point on one bed."""
