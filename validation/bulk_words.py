"""The words of docs/validation/bulk.md; what a script works out stands in braces."""

TEXT = """\
# Bulk behaviour of grains

Do many grains together behave as published experiments and simulations, and is a bed of the usual size large enough?

- **Angle of repose and compression** agree with the published values to a few per cent.
- **Platonic solids**: the solid fractions of tetrahedron and cube agree within about 0.01 with those of dice that
  settled in a flow. Octahedron, dodecahedron and icosahedron pack more densely than settled and less densely than
  shaken dice.
- **Froude scaling** holds for the penetration. The durations scatter too much for a conclusion.
- **Beds twice as wide and deep** give lower means in {below} of {count} cases. The largest difference is {most}
  standard errors.

"+-" is the standard deviation between simulations.

## Angle of repose

A box is filled, one end is opened, and a heap remains. Published angles of repose are about 25 degrees for rounded and
40 for angular grains (Kleinhans 2011). The heap is lower than the filling, because its slope reaches the back wall.

{repose}

A heap of 6-point hulls (41.5 degrees) is left out, because some of its grains were still falling when the box opened.

## Compression

Spheres are compressed from six sides. Published values are those of Agnolin and Roux (2007).

{compression}

## Poured beds by friction

Beds have 150 hulls. Solid fraction and coordination number decrease with friction, as they should.

{friction}

## Packing of the Platonic solids

The solids are poured at 2 m/s with friction 0.5. The published values are for plastic dice (Baker and Kudrolli 2010).
The table lists those of dice that settled in a flow; for shaken dice they are 0.64, 0.67, 0.64, 0.63 and 0.59, each
+-0.01.

{packing}

## Froude scaling

A sphere is dropped into beds at three gravities. Equal Froude numbers should give equal scaled values. The means of the
three gravities at one Froude number differ by {gravities} times the scatter between simulations. The mean duration is
largest at the highest gravity for each Froude number, but two or three simulations per gravity cannot show whether
this is chance.

{froude}

## Size of the bed

The same landings were simulated on several beds of 150 grains, 0.7 m wide ("plain"), and on beds of 1200 grains, twice
as wide and deep ("double"). The rule of the smallest bed requires {rule}. Brackets hold the number of beds; "+-" is the
standard deviation between beds.

{beds}

The plain beds exceed the rule. No difference is significant by itself, but the {count} values share their beds and are
not independent, and all have the same sign. A difference of the size measured, up to {largest} of the value ({which}),
is not excluded.

The landings: {made}.

## Limits

Each check has one to eight simulations per row. Grains are spheres, hulls of 6 or 14 points and the Platonic solids.

## Reproduce this page

`python validation/bulk_figures.py` writes the page and its figures from the kept results. The command under each table
computes it again.
"""
