"""Steps that all contacts share: neighbours, sums of forces, how long a step may be, the time loop on its threads."""
