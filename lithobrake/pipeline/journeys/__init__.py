"""Landers that are followed from delivery to their ends, and what answers their touchdowns."""
