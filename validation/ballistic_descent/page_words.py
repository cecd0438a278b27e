"""The words of docs/validation/ballistic_descent.md; what a script works out stands in braces."""

TEXT = """\
# Ballistic descents to Dimorphos

At which longitudes does a lander that descends without propulsion reliably come to rest on the moon of a binary
asteroid, and do these longitudes agree with published ones?

- **At the lowest possible touchdown speed, they hardly agree.** The published longitudes are not clearly better than
  the others: the mean fractions at rest differ by {least_low} to {least_high} with restitution 0.5 and 0.7. With 0.9
  they differ by {last_low} to {last_high}.
- **At the best touchdown speed, they agree in part.** The published longitudes are better by {best_low} to {best_high}
  on hard ground (restitution 0.5 and 0.7, releases from 300 m). Of {bounded} bands of reliable longitudes on hard
  ground, {agree} have both ends within {bar} degrees of the published ones.
- **On the soil of the mission study** nearly all landers that touch down come to rest. After releases from 400 m at
  least {soil_400} come to rest at every longitude; from 1 km it is {soil_1000} at the best one.

![Fraction at rest](ballistic_descent.png)

## Published work

[Celik-2019] and [Sanchez-2017] ask where such a lander can be released. They use the circular restricted three-body
problem, touchdown along the local vertical, release errors of 90 m and 2 cm/s (3 sigma), and restitution as the design
parameter. Their result for the larger moons is a band of reliable longitudes, 320 to 20 degrees near the equator.

Only the abstracts could be read. They state neither the release distance, nor the fraction that counts as reliable, nor
the origin of longitude. [Sanchez-2017] has other errors (1 sigma 10 m and 1 cm/s). Distances and fractions are
therefore
scanned here. Longitudes are counted east from the meridian that faces away from Didymos: in the three-body problem the
axis points from the larger to the smaller body.

The touchdown speed is chosen in two ways. "Lowest speed" is the lowest of 24 for which a descent from that distance
exists. "Best speed" is the one at which most landers come to rest, because the published touchdown speeds followed from
the restitution.

## Set-up

There are {sites} sites on the equator, and as many at 20 and at 40 degrees for one distance (the model is symmetric
north and south). The body is a sphere of Dimorphos' volume ({radius} m), {apart} m from Didymos. The landers touch down
along the vertical of each site, at 24 speeds from 4.8 to 14 cm/s. The descent is integrated back in time to the
release, at a given distance from the moon's centre. From there {landers} landers with the errors of [Celik-2019] fly in
the gravity of both bodies, bounce, and either come to rest within two days or do not.

On hard ground the tangential restitution is 0.9, limited by a friction of 0.6. Captured landers slide with that
friction. On soil, each impact repeats one of the 20 simulated touchdowns of `scenarios/mission.toml` that are nearest
in
speed and impact angle.

## Mean fractions at rest, on the equator

{means}

Descents at the lowest speed spend a long time near the Lagrange points, where the release errors grow. The release
distance matters as much as the site, and the published abstracts do not state it. Fractions have a standard error of up
to 5 points ({landers} landers). The best of 24 speeds is biased upwards by some points.

## Bands on the equator, at the best speed

A band is the range of longitudes around the highest fraction in which at least a given fraction of the landers comes to
rest. The table lists its ends in degrees. In bold bands, both ends are within {bar} degrees of 320 and 20.

{bands}

The bands that agree are about 60 degrees long. Bands are wider for closer releases and for lower fractions. If
longitudes are counted from the side that faces Didymos, {other} bands agree.

## Other latitudes, released at {map} m, at the best speed

{latitudes}

## Limits

- The published release distance, threshold and origin of longitude are unknown, so any agreement depends in part on the
  choices made here.
- On soil, released at {map} m, the best speed is the highest that was tried at {at_end} of {sites} longitudes.
  Fractions there are lower bounds.
- The moon is a sphere, and only one lander and one soil are used.

## Reproduce this page

`python validation/ballistic_descent/write_page.py` writes the page and its figure. The descents: {made}, without the
mission study, which is computed if it is missing.
"""
