"""Every contact at steps of its own: an agenda of what is due, and bodies that move under steady forces in between."""
