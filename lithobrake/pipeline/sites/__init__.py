"""A grid of sites over the body, each with what becomes of landers that are delivered there."""
