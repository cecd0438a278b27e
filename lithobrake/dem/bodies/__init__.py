"""Shapes, materials and bodies as a person gives them, the arrays of all of them, and how bodies move."""
