"""Compiled kernels, and what is computed once for this machine and user."""
