"""Nowcast: from an observed first contact to the ground under it and the place of rest."""
