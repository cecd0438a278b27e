"""The default fit on functions that the field compares itself with, and bounds on its error at few runs."""

import numpy as np
import pytest

from lithobrake.chaos import LogNormal, Normal, Uniform, fit, sobol_sequence

BOREHOLE = {
    "radius": Normal(0.1, 0.0161812), "influence": LogNormal(7.71, 1.0056),
    "upper_transmissivity": Uniform(63070.0, 115600.0), "upper_head": Uniform(990.0, 1110.0),
    "lower_transmissivity": Uniform(63.1, 116.0), "lower_head": Uniform(700.0, 820.0),
    "length": Uniform(1120.0, 1680.0), "conductivity": Uniform(9855.0, 12045.0),
}  # fmt: skip
OTL = {
    "b1": Uniform(50.0, 150.0), "b2": Uniform(25.0, 70.0), "f": Uniform(0.5, 3.0), "c1": Uniform(1.2, 2.5),
    "c2": Uniform(0.25, 1.2), "beta": Uniform(50.0, 300.0),
}  # fmt: skip
PISTON = {
    "mass": Uniform(30.0, 60.0), "area": Uniform(0.005, 0.020), "volume": Uniform(0.002, 0.010),
    "spring": Uniform(1000.0, 5000.0), "pressure": Uniform(90000.0, 110000.0), "ambient": Uniform(290.0, 296.0),
    "filling": Uniform(340.0, 360.0),
}  # fmt: skip
WING = {
    "area": Uniform(150.0, 200.0), "fuel": Uniform(220.0, 300.0), "aspect": Uniform(6.0, 10.0),
    "sweep_deg": Uniform(-10.0, 10.0), "pressure": Uniform(16.0, 45.0), "taper": Uniform(0.5, 1.0),
    "thickness": Uniform(0.08, 0.18), "load": Uniform(2.5, 6.0), "gross": Uniform(1700.0, 2500.0),
    "paint": Uniform(0.025, 0.08),
}  # fmt: skip
FRIEDMAN = {f"x{k}": Uniform(0.0, 1.0) for k in range(1, 11)}


def borehole(x):
    """Source: Harper and Gupta, 1983."""
    radius, influence, tu, hu, tl, hl, length, conductivity = x.T
    logarithm = np.log(influence / radius)
    return (
        2.0 * np.pi * tu * (hu - hl)
        / (logarithm * (1.0 + 2.0 * length * tu / (logarithm * radius**2 * conductivity) + tu / tl))
    )  # fmt: skip


def otl(x):
    """Output transformerless push-pull circuit. Source: Ben-Ari and Steinberg, 2007."""
    b1, b2, f, c1, c2, beta = x.T
    base, load = 12.0 * b2 / (b1 + b2), beta * (c2 + 9.0)
    return (base + 0.74) * load / (load + f) + 11.35 * f / (load + f) + 0.74 * f * load / ((load + f) * c1)


def piston(x):
    """Cycle time of a piston. Source: Kenett and Zacks, 1998."""
    mass, area, volume, spring, pressure, ambient, filling = x.T
    force = pressure * area + 19.62 * mass - spring * volume / area
    stroke = area / (2.0 * spring) * (np.sqrt(force**2 + 4.0 * spring * pressure * volume * ambient / filling) - force)
    return 2.0 * np.pi * np.sqrt(mass / (spring + area**2 * pressure * volume * ambient / (filling * stroke**2)))


def wing_weight(x):
    """Weight of a light aircraft's wing [lb]. Source: Forrester, Sobester and Keane, 2008, Eq 1.20."""
    area, fuel, aspect, sweep_deg, pressure, taper, thickness, load, gross, paint = x.T
    cosine = np.cos(np.deg2rad(sweep_deg))
    return (
        0.036 * area**0.758 * fuel**0.0035 * (aspect / cosine**2) ** 0.6 * pressure**0.006 * taper**0.04
        * (100.0 * thickness / cosine) ** -0.3 * (load * gross) ** 0.49
        + area * paint
    )  # fmt: skip


def friedman(x):
    """Five inputs matter, five do not. Source: Friedman, 1991, Eq 61."""
    return 10.0 * np.sin(np.pi * x[:, 0] * x[:, 1]) + 20.0 * (x[:, 2] - 0.5) ** 2 + 10.0 * x[:, 3] + 5.0 * x[:, 4]


# Errors measured over seeds 1 to 3 stay below half of these limits.
@pytest.mark.parametrize(
    ("inputs", "model", "count", "limit"),
    [
        (BOREHOLE, borehole, 100, 0.02),
        (OTL, otl, 80, 0.01),
        (PISTON, piston, 100, 0.15),
        (WING, wing_weight, 100, 0.02),
        (FRIEDMAN, friedman, 150, 0.05),
    ],
    ids=["borehole", "otl", "piston", "wing weight", "friedman"],
)
def test_default_on_few_runs(inputs, model, count, limit):
    x, test = sobol_sequence(inputs, count, seed=1), sobol_sequence(inputs, 1000, seed=9)
    surrogate = fit(inputs, x, model(x))
    score = surrogate.score(test, model(test))["y"]
    assert score["rrmse"] < limit
    assert score["q2"] == pytest.approx(1.0 - score["rrmse"] ** 2)
    assert 0.3 < surrogate.report["rrmse_estimate"][0] / score["rrmse"] < 3.0
