"""How many beds, each an independent piece of ground, a statement takes at least (docs/estimates.md)."""

# Of a study whose file does not say how many it has: on fewer an interval is far wider.
FEWEST_BEDS_OF_INTERVAL = 12
# Of a quantile far out: on fewer a handful of runs beyond it lie on one or two beds.
FEWEST_BEDS_OF_TAIL = 10
# Of the correlation of pairs by the sums over beds: fewer say less of it than the pairs do.
FEWEST_BEDS_OF_CORRELATION = 8
# Of landings and emulator compared in a region.
FEWEST_BEDS_OF_REGION = 4
