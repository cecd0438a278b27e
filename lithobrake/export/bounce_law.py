"""The stochastic rebound of a study as one file for other programs, with a reader in Python and one in C."""

import json
import zlib
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.export.flown import ExportOptions
from lithobrake.files.atomic import write_whole
from lithobrake.results import NamedEmulator, StudyResults, Table
from lithobrake.results.named_emulator import AZIMUTH, trained_range
from lithobrake.study.units import input_units
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    GROUND,
    GROUND_KIND,
    IMPACT_SPEED,
    OF_TOUCHDOWN,
    ORIENTATION_OUT,
    PURE,
    SPIN,
    SPIN_OUT,
    TO_REST,
)

if TYPE_CHECKING:
    from lithobrake.results.table import ExplorerTables

# The first line of the file; readers of another version refuse it.
TITLE = "lithobrake bounce law 1"
LAW = "bounce_law.txt"
READERS = ("bounce_law.py", "bounce_law.h", "bounce_law.c")
# Fits to other draws of beds that the file carries: enough for a standard deviation, at a tenth of the size of all.
FITS = 20
WIDTH = 110
ALONG, ASIDE, DURATION, _, RISE = TO_REST
# Tables that each fit has of its own, and those that all share.
OF_FIT = (
    "location", "log_scale", "scale_limits", "rows", "row_weights", "smoothing_size", "smoothing_root",
    "class_intercepts", "class_slopes", "class_never",
)  # fmt: skip
OF_ALL = ("is_log", "germ_zero", "germ_slope", "center", "spread", "multi_indices", "kernel_widths", "row_inputs",
    "distant")  # fmt: skip
OF_BOUND = ("height", "across", "time_limit", "smallest", "largest", "mass_power", "diameter_power")
BOUND_INPUTS = (IMPACT_SPEED, GROUND[1], GROUND[0], "lander.mass", "lander.diameter")
HEAD = (
    "The law draws how a touchdown of a lander ends: the emulator of all touchdowns of a study's journeys. "
    "bounce_law.py and bounce_law.c read this file and draw the same numbers. After this head it has blocks of words: "
    "names NAME COUNT, or numbers NAME RANK SIZES, each followed by its values, the last index first to change. Its "
    "last line is the CRC-32 of all bytes before it.",
    "Frame of a touchdown: x along the incoming horizontal velocity, z along the outward normal of the ground that is "
    "touched, y = z cross x, so that y is to the left of the motion seen from above. Without horizontal velocity x is "
    "any direction. Nothing is mirrored: y keeps its sign. Velocities and spins are against the ground, which turns "
    "with the body.",
    "Incidence: angle between velocity and inward normal. Gravity: size of the acceleration of what rests there, "
    "centrifugal acceleration included, below 0 where it points outward; slope: angle between it and the inward "
    "normal, in any direction. Attitudes: unit quaternions w, x, y, z that turn the lander's axes, those of the study "
    "file, into the frame.",
    "Outputs of one draw: outcome; velocity [m/s]; spin [rad/s]; attitude at the end, of the landing whose scatter was "
    "drawn, whatever the attitude of the arrival; duration [s] and way of the centre of mass [m] from first contact to "
    "the end, of that landing. A captured lander has duration, way and attitude of a landing that was captured. "
    "Attitude of the arrival and ground are conditions; impact point, bed and spin of the arrival are in the scatter.",
)


def write_bounce_law(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write the law of the touchdown emulator, and beside it its readers.

    Raises ValueError for a study that has no emulator of its touchdowns.
    """
    explorer = results.touchdown_explorer
    if explorer is None:
        raise ValueError(
            f"{results.folder} has no emulator of touchdowns, of which a bounce law is made; "
            "run a study that follows landers over their touchdowns ([journey]), more of them if these were too few"
        )
    body = "\n".join([TITLE, *_head(results), *_blocks(results, explorer)]) + "\n"
    law, *readers = paths
    write_whole(law, f"{body}end {zlib.crc32(body.encode()):08x}\n")
    for path in readers:
        write_whole(path, files("lithobrake.export").joinpath("readers", path.name).read_text(encoding="utf-8"))


def _head(results: StudyResults) -> list[str]:
    """Comments: the study, its lander and grounds, and how the file is read."""
    from lithobrake import __version__

    lander = {key: value for key, value in results.study["lander"].items() if value not in (None, {}, [])}
    ground = results.study.get("ground") or {}
    said = [
        f"Written by lithobrake {__version__} from the study {json.dumps(results.study['title'])}.",
        f"Lander: {json.dumps(lander)}",
        results.emulator.model.statement_on("beds"),
        *HEAD,
    ]
    if ground.get("kind"):
        kinds = ", ".join(f"{number} {name}" for number, name in enumerate(ground["kind"]))
        said.append(f"Grounds by {GROUND_KIND}: {kinds}. A journey has one: draw it with the soil.")
    return [f"# {line}" for paragraph in said for line in wrap(paragraph, WIDTH, break_on_hyphens=False)]


def _blocks(results: StudyResults, explorer: "ExplorerTables") -> list[str]:
    """All names and numbers of the law."""
    emulator, touchdowns = results.emulator, results.touchdowns
    own, runs = emulator.tables, emulator.model.runs
    columns = list(runs.modelled)
    conditions = _conditions(emulator, explorer, touchdowns)
    units = input_units()
    names = {
        "conditions": list(conditions),
        "units": [units.get(name) or PURE for name in conditions],
        "outcomes": list(runs.outcome_names),
    }
    fits = {name: np.concatenate([own[name], explorer.tables[name][:FITS]]) for name in OF_FIT}
    numbers = {
        "lower": [lower for lower, _ in conditions.values()],
        "upper": [upper for _, upper in conditions.values()],
        **{name: own[name] for name in OF_ALL},
        **fits,
        "output_lower": runs.lower[0, columns],
        "output_upper": runs.upper[0, columns],
        "outcome_places": _outcome_places(emulator),
        **_rows(emulator, touchdowns),
        **_attitude(explorer),
        **_bound(explorer, list(conditions)),
        **_soils(touchdowns, explorer, conditions),
    }
    texts = [line for name, words in names.items() for line in (f"names {name} {len(words)}", " ".join(words))]
    return texts + [line for name, values in numbers.items() for line in _numbers(name, np.asarray(values, float))]


def _numbers(name: str, values: Array) -> list[str]:
    """A block of numbers, to the last bit, a line for each row."""
    sizes = " ".join(map(str, values.shape))
    rows = values.reshape(-1, values.shape[-1]) if values.size else values.reshape(0, 1)
    return [
        f"numbers {name} {values.ndim} {sizes}",
        *(" ".join(repr(value).removesuffix(".0") for value in row) for row in rows.tolist()),
    ]


def _conditions(
    emulator: NamedEmulator, explorer: "ExplorerTables", touchdowns: Table
) -> dict[str, tuple[float, float]]:
    """What the law reads of a touchdown, each with its range: first the inputs of the emulator, but its attitude's."""
    least = np.finfo(float).tiny
    found = {
        # There is no logarithm of zero.
        name: (max(law.support[0], least) if law.logarithmic else law.support[0], law.support[1])
        for name, law in emulator.model.runs.inputs.items()
        if name not in explorer.attitude_inputs
    }
    # What was the same in all touchdowns is no input of the emulator, and the law holds for no other.
    others = [name for name in OF_TOUCHDOWN if name not in found]
    return found | {
        name: trained_range(name, float(touchdowns[name].min()), float(touchdowns[name].max())) for name in others
    }


def _outcome_places(emulator: NamedEmulator) -> list[int]:
    """Places of the outcomes with which a lander leaves, and is captured; -1 for one that no touchdown had."""
    names = emulator.model.outcome_names
    rests = TouchdownOutcome.CAPTURED
    return [emulator.model.runs.output_outcome, names.index(rests) if rests in names else -1]


def _rows(emulator: NamedEmulator, touchdowns: Table) -> dict[str, Array]:
    """What is drawn with its landing unchanged.

    leaving_rows [row_count, 12]: azimuth, axis of the spin, duration, way and attitude; rest_rows [count, 8] of
    captured landers: duration, way and attitude.
    """
    runs, outcome = emulator.model.runs, touchdowns["outcome"]
    left, rests = (touchdowns.where(outcome == name) for name in (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED))
    drawn = dict(zip(runs.output_names, runs.y.T, strict=True))
    # The table and the emulator have the same landings in the same order, or no attitude would be that of its row.
    if not np.array_equal(left["speed_out"], drawn["speed_out"]):
        raise ValueError("the touchdowns of the study are not those of its emulator: run the study again")
    azimuth = drawn[AZIMUTH]
    if SPIN_OUT[0] in drawn:
        axis = np.column_stack([drawn[name] for name in SPIN_OUT])
    else:
        # Landings that tell no axis roll along their velocity.
        axis = np.column_stack([-np.sin(azimuth), np.cos(azimuth), np.zeros(len(azimuth))])
    length = np.linalg.norm(axis, axis=1, keepdims=True)
    return {
        "leaving_rows": np.column_stack([azimuth, axis / np.where(length > 0.0, length, 1.0), _told(left)]),
        "rest_rows": _told(rests),
    }


def _told(touchdowns: Table) -> Array:
    """Duration and way, 0 where landings lack them, and attitude at the end, NaN where they lack it, [count, 8]."""
    absent = np.full(touchdowns.row_count, np.nan)
    known = {name: touchdowns.get(name, absent) for name in (*TO_REST, *ORIENTATION_OUT)}
    motion = [np.nan_to_num(known[name]) for name in (DURATION, ALONG, ASIDE, RISE)]
    return np.column_stack([*motion, *(known[name] for name in ORIENTATION_OUT)])


def _attitude(explorer: "ExplorerTables") -> dict[str, Any]:
    """Axes of the lander [axis_count, 3], kind of its terms, and their ranges [term_count, 2]; none for a ball."""
    from lithobrake.geometry.attitude import AttitudeTerms

    law = explorer.attitude
    if law is None:
        return {"attitude_axes": np.empty((0, 3)), "attitude_kind": [0, 0], "attitude_ranges": np.empty((0, 2))}
    names = tuple(str(number) for number in range(len(law.axes)))
    terms = AttitudeTerms(np.array(law.axes), names, law.has_sides, law.is_cube)
    ranges = list(terms.ranges.values())
    return {"attitude_axes": law.axes, "attitude_kind": [law.has_sides, law.is_cube], "attitude_ranges": ranges}


def _bound(explorer: "ExplorerTables", conditions: list[str]) -> dict[str, list[float]]:
    """Numbers of the energy bound, the last of them the median spin, and where what it depends on is found."""
    bound = explorer.bound
    spin = float(np.linalg.norm([bound[name] for name in SPIN]))
    inputs = [name if name in explorer.input_names else None for name in BOUND_INPUTS]
    return {
        "bound": [*(bound[name] for name in OF_BOUND), spin],
        "bound_places": [-1 if name is None else conditions.index(name) for name in inputs],
        "bound_medians": [bound.get(name, 0.0) for name in BOUND_INPUTS],
    }


def _soils(
    touchdowns: Table, explorer: "ExplorerTables", conditions: Mapping[str, tuple[float, float]]
) -> dict[str, Any]:
    """What landers of the study met at their first touchdowns [count, input_count], and its places."""
    names = [name for name in conditions if name not in OF_TOUCHDOWN]
    first = touchdowns.where((touchdowns["touchdown"] == 0) & (touchdowns["outcome"] != "failed"))
    # A law without an end has one in the emulator, and soils of regions may lie beyond.
    columns = [np.clip(first[name], *conditions[name]) for name in names]
    soils = np.column_stack(columns) if names else np.empty((first.row_count, 0))
    return {"soils": soils, "soil_places": [list(conditions).index(name) for name in names]}
