"""What two do to each other where they touch; contact_law.py has the walk of one contact."""
