"""Every sentence about the results of a study that has a number in it; summary, page and command line take it here."""
