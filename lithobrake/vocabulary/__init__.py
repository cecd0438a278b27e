"""The words and quantities that every part uses: outcomes, outputs with their units, plain text."""
