"""What moves on the page: explorer and views in three dimensions."""
