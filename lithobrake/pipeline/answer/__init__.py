"""The answer: estimates with intervals, shares, limit states, and their sentences."""
