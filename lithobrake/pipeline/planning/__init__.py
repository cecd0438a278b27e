"""What a study will make, what it will cost, and what to know of it before it runs."""
