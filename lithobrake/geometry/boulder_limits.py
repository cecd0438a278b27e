"""What a bed takes of boulders at most: for who makes them, and who checks a study without loading a solver."""

# How far a boulder reaches from its centroid, in diameters of the sphere of equal volume. An ellipsoid with the axes of
# blocks on Ryugu, 2 : sqrt(2) : 1, reaches 0.71. Source: [Michikami-2022].
BOULDER_REACH = 0.75
# Discs dropped at random cover 0.547 of the ground until no more fits [Feder-1980]; boulders are wider than these.
LARGEST_COVERAGE = 0.3
