"""A covariance is one input: what correlated inputs explain, against laws in closed form."""

from typing import Any

import numpy as np
import pytest

from lithobrake.analysis import FailureInput, regression_terms, variance_shares
from lithobrake.chaos import Distribution, Normal
from lithobrake.pipeline.answer.correlated_inputs import (
    groups_of_inputs,
    independent_columns,
    less_first,
    significant_together,
)
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.study import StudySource
from lithobrake.vocabulary.estimate import Estimate

from ..journeys.bouncing_lander import journey_tables

# Linear correlation of two normal keys, and Spearman's that goes with it [Kruskal-1958].
LINEAR = 0.8
RANK = 6.0 / np.pi * np.arcsin(0.5 * LINEAR)
COUNT, BEDS = 2400, 24
FIRST, SECOND, FRICTION = "impact.spin_x", "impact.spin_y", "grain.friction"
LAWS: dict[str, Distribution] = {FRICTION: Normal(0.5, 0.1), FIRST: Normal(0.0, 0.01), SECOND: Normal(0.002, 0.005)}


def design_of(**delivery: Any) -> DrawnDesign:
    laws = {FIRST: {"distribution": "normal", "mean": 0.0, "std": 0.01}}
    laws[SECOND] = {"distribution": "normal", "mean": 0.002, "std": 0.005}
    keys = {name.partition(".")[2]: law for name, law in laws.items()} | delivery
    return DrawnDesign(StudySource.of_tables(journey_tables(delivery=keys)).study)


@pytest.fixture(scope="module")
def columns() -> dict[str, np.ndarray]:
    """Soil, and two rates of spin that the study correlates, and both make an output larger."""
    design = design_of(correlations=[["spin_x", "spin_y", float(RANK)]]).with_run_count(COUNT)
    rows = design.delivered_rows
    drawn = {name: np.array([row[name] for row in rows]) for name in (FIRST, SECOND)}
    return {FRICTION: np.random.default_rng(2).normal(0.5, 0.1, COUNT), **drawn}


def output(columns: dict[str, np.ndarray]) -> np.ndarray:
    """Variance 1 of the soil, 1 + 1 + 2 r of the delivery, 1 of all else."""
    germs = [law.germ(columns[name]) for name, law in LAWS.items()]
    return np.sum(germs, axis=0) + np.random.default_rng(3).standard_normal(COUNT)


def test_the_delivery_is_one_input_with_what_its_keys_explain_together(columns: dict[str, np.ndarray]) -> None:
    """Of a variance of 1 + 2 (1 + r) + 1 = 5.6 the delivery has 3.6 and the soil 1."""
    assert np.corrcoef(columns[FIRST], columns[SECOND])[0, 1] == pytest.approx(LINEAR, abs=0.02)
    study = design_of(correlations=[["spin_x", "spin_y", float(RANK)]]).study
    y, bed = output(columns), np.arange(COUNT) % BEDS
    found = variance_shares(LAWS, independent_columns(study, columns), y, bed, soil=[FRICTION])
    assert found is not None
    assert found.arrival is not None
    assert found.variance == pytest.approx(5.6, rel=0.06)
    assert found.arrival.value == pytest.approx(3.6 / 5.6, abs=0.03)
    assert found.soil.value == pytest.approx(1.0 / 5.6, abs=0.03)
    # As if its keys were independent the delivery had 2 of 4, and the soil a quarter.
    plain = variance_shares(LAWS, np.column_stack([*columns.values()]), y, bed, soil=[FRICTION])
    assert plain is not None
    assert plain.soil.value == pytest.approx(0.25, abs=0.04)


def test_terms_of_correlated_inputs_have_mean_0_and_no_correlation(columns: dict[str, np.ndarray]) -> None:
    """The product of both rates has the mean r, which would bias what a regression takes off."""
    study = design_of(correlations=[["spin_x", "spin_y", float(RANK)]]).study
    terms, indices = regression_terms(LAWS, independent_columns(study, columns))
    plain, _ = regression_terms(LAWS, np.column_stack([*columns.values()]))
    product = int(np.flatnonzero((indices == [0, 1, 1]).all(axis=1))[0])
    assert plain[:, product].mean() == pytest.approx(LINEAR, abs=0.05)
    assert terms[:, product].mean() == pytest.approx(0.0, abs=0.05)
    assert np.corrcoef(terms[:, indices.sum(axis=1) == 1].T) == pytest.approx(np.eye(3), abs=0.05)


def test_inputs_that_are_not_correlated_stay_as_they_are(columns: dict[str, np.ndarray]) -> None:
    points = independent_columns(design_of().study, columns)
    assert (points == np.column_stack([*columns.values()])).all()


def test_what_one_number_tells_of_another_is_taken_off_and_its_values_stay() -> None:
    """Speed and incidence after flights from one release: the part of the second that the first leaves open."""
    random = np.random.default_rng(4)
    first = random.standard_normal(4000)
    second = np.exp(0.8 * first + 0.6 * random.standard_normal(4000))
    found = less_first(first, second)
    assert (np.sort(found) == np.sort(second)).all()
    assert np.corrcoef(first, np.log(found))[0, 1] == pytest.approx(0.0, abs=0.01)
    assert (less_first(np.ones(3), second[:3]) == second[:3]).all()


def test_inputs_that_go_together_are_significant_together() -> None:
    """Links make one group, also through a third key; an input outside of it stays as it is."""
    error = {"distribution": "normal", "mean": 0.0, "std": 10.0}
    pairs = [["spin_x", "spin_y", 0.3], ["north_error", "east_error", 0.2], ["north_error", "spin_y", 0.2]]
    study = design_of(correlations=pairs, north_error=error, east_error=error).study
    assert groups_of_inputs(study) == [{FIRST, SECOND, "site.north_error", "site.east_error"}]
    far, near = (Estimate(value, 0.0, 1.0) for value in (0.5, 0.1))
    found = {name: FailureInput(far if name == FIRST else near, 0.2, 1.0, 1.0) for name in (*LAWS, "site.north_error")}
    told = {name: one.found for name, one in significant_together(study, found).items()}
    assert told == {FRICTION: False, FIRST: True, SECOND: True, "site.north_error": True}
    alone = {name: one.found for name, one in significant_together(design_of().study, found).items()}
    assert alone == {FRICTION: False, FIRST: True, SECOND: False, "site.north_error": False}
