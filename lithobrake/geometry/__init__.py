"""Meshes as they are read from files, with their units, and attitudes as quaternions."""
