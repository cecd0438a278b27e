"""Readers of a bounce law in plain Python and in C, which an export lays next to the law; no part of the package."""
