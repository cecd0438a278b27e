"""How a file is written whole, read with care, and recognised by its content."""
