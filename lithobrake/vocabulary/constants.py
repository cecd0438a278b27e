"""Numbers that do not depend on any study: constants of nature, sizes of units, and fewest beds of a statement."""

GRAVITATIONAL_CONSTANT = 6.67430e-11  # m3/(kg s2), CODATA 2018
MINUTE, HOUR, DAY = 60.0, 3600.0, 86_400.0  # s
CENTIMETRES = 100.0  # in a metre
# Probability as near to 0, or to 1, as a sample comes.
LEAST_PROBABILITY = 2.0**-53


# Of a study whose file does not say how many it has: on fewer an interval is far wider.
FEWEST_BEDS_OF_INTERVAL = 12
# Landings that leave the surface, of an emulator.
FEWEST_RUNS_OF_EMULATOR = 8
# Of a quantile far out: on fewer a handful of runs beyond it lie on one or two beds.
FEWEST_BEDS_OF_TAIL = 10
# Of the correlation of pairs by the sums over beds: fewer say less of it than the pairs do.
FEWEST_BEDS_OF_CORRELATION = 8
# Of landings and emulator compared in a region.
FEWEST_BEDS_OF_REGION = 4
# Fits of an emulator to beds drawn with replacement: each sample or lander is of one of them, and keeps it.
REFIT_COUNT = 50
# Runs that all end alike do not show how alike those on one bed are. Of 100 studies one exceeds this correlation, by
# what earlier ones have shown (benchmarks/bed_correlation.py); limits of what no run has met hold up to it.
LARGEST_CORRELATION = 0.5
