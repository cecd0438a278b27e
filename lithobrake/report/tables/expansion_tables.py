"""Tables of the expansions: their designs, fits, errors and indices, and the outputs of their samples."""

from collections.abc import Iterable, Mapping
from typing import Any

from lithobrake.report.content import PageTable, show, table_cell, unit_scales
from lithobrake.results.model_results import Ends, SampleResults
from lithobrake.results.page_data import PageExpansion
from lithobrake.statements import notes
from lithobrake.statements.expansion import MODEL
from lithobrake.statements.labels import PAPER_OUTPUTS, bracket, input_words, output, two_digits
from lithobrake.vocabulary.number_words import fixed

STAGE_WORDS = {
    "screening": "screening: its own runs",
    "test_screening": "screening: test, all inputs vary",
    "refined": "refined: its own runs",
    "test_kept": "refined: test, kept inputs vary",
    "test_all": "refined: test, all inputs vary",
}
INPUT_COLUMNS = ("input", "key in the study file", "distribution", "parameters")
DESIGN_WORDS = {
    "screening": "screening, all inputs",
    "refined": "refined, kept inputs",
    "test_kept": "test, kept inputs vary",
    "test_all": "test, all inputs vary",
}


def sure_tables(data: PageExpansion) -> list[PageTable]:
    """The errors of the expansions, and how these were fitted."""
    return [_scores(data), _fits(data)]


def inputs_table(data: PageExpansion, study: Mapping[str, Any]) -> PageTable:
    """The uncertain inputs, and which the refined design varies; study: the tables of its file."""
    kept = data.results.kept_inputs
    rows = []
    for name in data.results.screening.inputs:
        value: Any = study
        for key in name.split("."):
            value = value[key]
        rows.append([*input_cells(name, value), "yes" if name in kept else "no"])
    return PageTable("Uncertain inputs", [*INPUT_COLUMNS, "kept"], rows)


def input_cells(name: str, law: Mapping[str, Any]) -> list[str]:
    """An uncertain input by dotted key, in the columns of INPUT_COLUMNS; law: as the summary has it."""
    parameters = ", ".join(f"{key} {show(entry)}" for key, entry in law.items() if key != "distribution")
    return [input_words(name), name, law["distribution"].replace("_", "-"), parameters]


def designs_table(data: PageExpansion) -> PageTable:
    rows = []
    for name, design in data.results.designs.items():
        outcomes = ", ".join(f"{count} {outcome.replace('_', ' ')}" for outcome, count in design.outcomes.items())
        rows.append([DESIGN_WORDS.get(name, name), str(design.run_count), str(design.with_outputs), outcomes])
    numbers = frozenset({"runs", "left the surface"})
    return PageTable("Touchdowns", ["design", "runs", "left the surface", "outcomes"], rows, numbers=numbers)


def _fits(data: PageExpansion) -> PageTable:
    columns = ["expansion", "output", "unit", "method", "terms", "condition number", "expected error"]
    columns.append("scatter between repeated runs")
    expansions = {"screening": data.results.screening, "refined": data.results.refined}
    scale = _output_scales((name, fit.rmse_estimate) for one in expansions.values() for name, fit in one.fits.items())
    rows = []
    for stage, expansion in expansions.items():
        for row, (name, fit) in enumerate(expansion.fits.items()):
            condition = "-" if fit.condition_number is None else f"{fit.condition_number:.3g}"
            scatter = "not known" if fit.noise_std is None else _in_unit(fit.noise_std, name, scale)
            of_fit = [fit.method.replace("_", " "), str(fit.term_count), condition]
            rows.append([*_first_cells(stage, row, name), *of_fit, _in_unit(fit.rmse_estimate, name, scale), scatter])
    note = (
        "Expected error: of a new run, by cross-validation, including scatter, below which no expansion can come. "
        "Scatter: from points that were run several times, or the nugget of a Gaussian process; where the expected "
        "error is smaller than the nugget, it is given instead."
    )
    return PageTable("How the expansions were fitted", columns, rows, note, frozenset(columns[4:]))


def _scores(data: PageExpansion) -> PageTable:
    columns = ["expansion and runs", "output", "unit", "MAPE [%]", "Q2", "RMSE", "spread (std)", "RMSE/spread"]
    scale = _output_scales((name, one.std) for table in data.results.scores.values() for name, one in table.items())
    rows = []
    for stage, table in data.results.scores.items():
        for row, (name, score) in enumerate(table.items()):
            q2 = "undefined" if score.q2 is None else fixed(score.q2, 3)
            rows.append([
                *_first_cells(STAGE_WORDS.get(stage, stage), row, name),
                _with_interval(_or_none(score.mape), score.mape_interval), _with_interval(q2, score.q2_interval),
                _in_unit(score.rmse, name, scale), _in_unit(score.std, name, scale), _or_none(score.rrmse),
            ])  # fmt: skip
    return PageTable("Errors of the expansions", columns, rows, notes.scores(), frozenset(columns[3:]))


def _first_cells(words: str, row: int, name: str) -> list[str]:
    """What the rows of a set of runs begin with: its words in the first one, the output and its unit."""
    return [words if row == 0 else "", output(name).words, output(name).unit]


def _in_unit(value: float, name: str, scale: Mapping[str, float]) -> str:
    """A number of an output [SI] in its unit."""
    shown = output(name)
    return table_cell(value * shown.factor, scale[shown.unit])


def sobol_table(data: PageExpansion) -> PageTable:
    """The indices of all inputs."""
    table = data.results.screening
    words = [output(name).words for name in PAPER_OUTPUTS]
    columns = ["input", *(f"{word}, first" for word in words), *(f"{word}, total" for word in words)]
    rows = [
        [
            input_words(key),
            *(_index(table.sobol_first[name][key], table.sobol_first_interval[name][key]) for name in PAPER_OUTPUTS),
            *(_index(table.sobol_total[name][key], table.sobol_total_interval[name][key]) for name in PAPER_OUTPUTS),
        ]
        for key in table.inputs
    ]
    return PageTable("Sobol indices", columns, rows, notes.sobol(), frozenset(columns[1:]))


def samples_table(samples: SampleResults) -> PageTable:
    """The outputs of the samples that leave; no row for samples of an emulator, whose outputs are those of the runs."""
    columns = ["output", "unit", "mean", "std", "5 %", "median", "95 %"]
    numbers = {
        name: (one.mean, one.std, *(one.quantiles[key] for key in ("quantile_0.05", "quantile_0.5", "quantile_0.95")))
        for name, one in (samples.outputs if samples.model == MODEL else {}).items()
    }
    scale = _output_scales((name, value) for name, values in numbers.items() for value in values)
    rows = [
        [output(name).words, output(name).unit, *(_in_unit(value, name, scale) for value in values)]
        for name, values in numbers.items()
    ]
    return PageTable("Outputs of the samples that leave", columns, rows, numbers=frozenset(columns[2:]))


def _output_scales(numbers: Iterable[tuple[str, float]]) -> dict[str, float]:
    """The largest magnitude of each unit among these numbers of outputs [SI], as they are shown."""
    return unit_scales((output(name).unit, value * output(name).factor) for name, value in numbers)


def _index(index: float, interval: tuple[float, float]) -> str:
    """One Sobol index with its interval."""
    return f"{fixed(index)}{bracket(*interval, fixed)}"


def _with_interval(words: str, interval: Ends) -> str:
    """A score in words, with its interval where there is one."""
    return words if None in interval else f"{words}{bracket(*interval, two_digits)}"


def _or_none(value: float | None) -> str:
    return "undefined" if value is None else table_cell(value)
