"""Whatever the page draws is what the package draws of the same random numbers, for outputs of every kind."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.emulator import Emulator, law_tables
from lithobrake.report.live.explorer import packed
from lithobrake.results import NamedEmulator, open_study
from lithobrake.vocabulary.file_names import EMULATOR_FILE, TOUCHDOWN_EMULATOR_FILE

from ..page_scripts import answer_of, explorer_data, needs_node

SHOWN = ("speed_out", "elevation_out", "spin_out")
POINTS, DRAWS = 30, 6
PROGRAM = """return given.laws.map((packedLaw) => {
  const law = new Law(unpack(packedLaw), given.facts);
  return given.x.map((x, p) => {
    const point = law.pointAt(Float64Array.from(x, (one, input) => law.germOf(input, one)));
    return given.outcome[p].map((one, d) => {
      const y = new Float64Array(3), row = law.draw(0, point, one, given.row[p][d], given.normal[p][d], 0, y);
      return row < 0 ? [-1 - row, null, null, null] : [law.withOutputs, ...y];
    });
  });
});"""


def with_bounds(model: Emulator, distant: tuple[str, ...], is_bounded: bool = True) -> Emulator:
    """The emulator with bounds of these outputs that bend no coordinate, or with a speed and a spin without bounds."""
    runs, names = model.runs, list(model.output_names)
    upper = runs.upper.copy()
    if not is_bounded:
        upper[:, [names.index("speed_out"), names.index("spin_out")]] = np.inf
    changed = replace(runs, upper=upper, distant=tuple(sorted(map(names.index, distant))))
    return replace(model, runs=changed).reweighted(model.weights)


def near_rows(model: Emulator, width: float) -> Emulator:
    """The emulator with rows that are drawn by their nearness in all inputs."""
    return replace(model, choices=replace(model.choices, widths=(width,) * len(model.runs.inputs)))


@needs_node
@pytest.mark.parametrize(("study", "section", "file"), [
    ("first_folder", "explorer", EMULATOR_FILE), ("asked_folder", "touchdown-explorer", TOUCHDOWN_EMULATOR_FILE),
])  # fmt: skip
def test_draws_of_the_page_are_those_of_the_package(
    study: str, section: str, file: str, request: pytest.FixtureRequest
) -> None:
    folder: Path = request.getfixturevalue(study)
    model, results = emulator.load(folder / file), open_study(folder)
    tables = results.explorer if section == "explorer" else results.touchdown_explorer
    assert tables is not None
    kinds = [((), True), *(((name,), True) for name in SHOWN), (SHOWN, True), ((), False), (SHOWN, False)]
    models = [model, near_rows(model, 1.5), *(with_bounds(model, *kind) for kind in kinds)]
    random = np.random.default_rng(2)
    x = np.column_stack([law.ppf(random.random(POINTS)) for law in model.runs.inputs.values()])
    stream = np.random.default_rng(9)
    # The same numbers in the same order as Emulator.draw takes them.
    numbers = {"outcome": stream.random((POINTS, DRAWS)), "row": stream.random((POINTS, DRAWS)),
               "normal": stream.standard_normal((POINTS, DRAWS, 3)), "x": x}  # fmt: skip
    laws = [packed({name: np.asarray(table, float) for name, table in law_tables([one]).items()}) for one in models]
    facts = explorer_data((folder / "report" / "index.html").read_text("utf-8"), section)["facts"]
    given = {"facts": facts, "laws": laws} | {name: one.tolist() for name, one in numbers.items()}
    found = np.array(answer_of(("live/law.js",), PROGRAM, given), dtype=float).reshape(len(models), -1, 4)
    inputs = dict(zip(model.runs.inputs, x.T, strict=True))
    for one, of_page in zip(models, found, strict=True):
        drawn = NamedEmulator(one, {}, lambda: tables.bound, tables.attitude).sample(inputs, DRAWS, seed=9)
        outcome = np.array(one.outcome_names)[of_page[:, 0].astype(int)]
        assert outcome.tolist() == drawn["outcome"].tolist()
        of_package = np.column_stack([drawn[name] for name in SHOWN])
        # Rounding may put a draw onto its bound, from which the package keeps the last bit.
        assert of_page[:, 1:] == pytest.approx(of_package, rel=1e-9, abs=1e-12, nan_ok=True)
        assert np.isfinite(of_package).any()
