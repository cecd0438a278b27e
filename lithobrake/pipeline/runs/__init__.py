"""The landings of a study: beds, designs, who makes them, and their table."""
