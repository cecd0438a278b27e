"""Numbers that do not depend on any study: a constant of nature, and sizes of units."""

GRAVITATIONAL_CONSTANT = 6.67430e-11  # m3/(kg s2), CODATA 2018
MINUTE, HOUR, DAY = 60.0, 3600.0, 86_400.0  # s
CENTIMETRES = 100.0  # in a metre
# Probability as near to 0, or to 1, as a sample comes.
LEAST_PROBABILITY = 2.0**-53
