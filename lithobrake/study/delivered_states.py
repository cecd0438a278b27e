"""States of landers from another tool: a table with units in its titles, or an ephemeris message."""

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.file_kinds import FileKind, file_kind
from lithobrake.files.oem_reader import USEABLE, MessageState, message_states, useable_time
from lithobrake.files.reading import read_text
from lithobrake.study.delivery_sections import LARGEST
from lithobrake.study.impact_sections import SiteSection
from lithobrake.study.state_paths import DeliveredStates, StateSegment, orbiter_path, path_warning, useable
from lithobrake.study.state_tables import table_states
from lithobrake.vocabulary.clock import Epoch, named_system
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES
from lithobrake.vocabulary.plain_text import program_name

if TYPE_CHECKING:
    from lithobrake.study.study import Study

# Frames of messages whose axes are those of ICRF within a tenth of an arc second.
ICRF_NAMES = ("ICRF", "ICRF1", "ICRF2", "ICRF3", "GCRF", "EME2000", "J2000")
# Frames that turn with a body, by its name.
FIXED_NAMES = ("{}_FIXED", "IAU_{}", "{}_BODY_FIXED")
# What to do with a file of another kind.
REMEDIES = {
    FileKind.BARE_OEM: "write CCSDS_OEM_VERS = 2.0 as its first line",
    FileKind.OPM: "write its state as [delivery.release], or as a row of a table",
    FileKind.UTF16: "save it in UTF-8",
}


def read_states(path: Path, frame: str, epoch: str | None, centres: Sequence[str]) -> DeliveredStates:
    """The states of a file, in its order.

    frame: as the study names it. epoch: when their time is 0; None: of a message, its earliest state. centres: names
    of the body, one of which a message must name as its centre.
    Raises ValueError with file, line and remedy.
    """
    try:
        kind = file_kind(path)
        # Spreadsheets begin a CSV file with a byte order mark.
        text = read_text(path) if kind in (None, FileKind.OEM) else ""
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise ValueError(f"{path.name} cannot be read ({why}); give the path of a CSV or OEM file in UTF-8") from error
    if kind is FileKind.OEM:
        return _of_message(list(message_states(Path(path.name), text)), path.name, frame, epoch, centres)
    if kind is not None:
        raise ValueError(
            f"{path.name} is {kind}; states are read from an OEM as keyword = value text, or from a CSV table: "
            f"{REMEDIES.get(kind, 'convert it')}"
        )
    return table_states(path.name, text)


def states_of(study: "Study") -> DeliveredStates:
    """The states that a study names, one a lander. Raises ValueError as read_states does."""
    delivery = study.delivery
    assert delivery is not None
    assert delivery.states is not None
    assert delivery.frame is not None
    return useable(read_states(Path(delivery.states), delivery.frame, delivery.epoch, names_of_body(study.site)))


def delivery_warning(study: "Study") -> str | None:
    """What the states of a study are beside one delivery a lander, in a sentence. Raises ValueError as states_of."""
    if study.delivery is None or study.delivery.states is None:
        return None
    return path_warning(states_of(study).rows(0, study.design.run_count))


def orbiter_states(study: "Study") -> tuple[DeliveredStates, np.ndarray]:
    """The body-fixed states of the orbiter that a study names, and the part of the time that each stands for.

    Raises ValueError as read_states and orbiter_path do.
    """
    orbiter = study.sky.orbiter
    assert orbiter is not None
    assert orbiter.states is not None
    states = read_states(Path(orbiter.states), "body_fixed", None, names_of_body(study.site))
    try:
        return orbiter_path(states)
    except ValueError as error:
        raise ValueError(f"the states {error}") from error


def names_of_body(site: SiteSection) -> list[str]:
    """Names of the body as a message may have them."""
    known = BUILT_IN_BODIES.get(site.body)
    own = site.body if known else site.name or Path(site.body).stem
    number = None if known is None or known.kernel_number is None else str(known.kernel_number)
    return list(dict.fromkeys(_plain(name) for name in (own, site.kernel_body, number) if name))


def _plain(name: str) -> str:
    """A name as a message writes it: capitals, digits and underscores, without the number of a minor planet before."""
    return re.sub(r"^_*\d+_+(?=[A-Z])", "", program_name(name.strip())).strip("_")


def _of_message(
    states: list[MessageState], name: str, frame: str, epoch: str | None, centres: Sequence[str]
) -> DeliveredStates:
    if not states:
        raise ValueError(f"{name} has no states; give a file with one line a lander")
    for state in states:
        _refuse_segment(state, name, frame, centres)
    start = min(state.epoch for state in states) if epoch is None else _start(epoch, states)
    time = np.array([state.epoch.since(start) for state in states])
    # An OEM is in km and km/s [CCSDS-2009].
    given, largest = np.array([state.numbers for state in states]), [1e-3 * LARGEST[unit] for unit in ("m", "m/s")]
    sizes = np.column_stack([np.abs(time), np.abs(given)])
    wrong = np.flatnonzero(~(sizes <= [LARGEST["s"], *np.repeat(largest, 3)]).all(axis=1))
    if len(wrong):
        raise ValueError(
            f"{name}, line {states[int(wrong[0])].line}: a number is not finite or too large; allowed: at most "
            f"{largest[0]:g} km, {largest[1]:g} km/s and {LARGEST['s']:g} s from the epoch; mend the line"
        )
    segments = {id(state.segment): state.segment for state in states}
    order = {key: number for number, key in enumerate(segments)}
    return DeliveredStates(
        [f"{name}, line {state.line}" for state in states],
        time,
        1e3 * given[:, :3],
        1e3 * given[:, 3:],
        segment=np.array([order[id(state.segment)] for state in states]),
        segments=[_segment(one, start) for one in segments.values()],
    )


def _segment(given: dict[str, str], start: Epoch) -> StateSegment:
    """What a segment says of its states; start: when their time is 0."""
    begin, end = (useable_time(given, key) for key in USEABLE)
    return StateSegment(
        given.get("OBJECT_NAME", ""),
        "INTERPOLATION" in given,
        -math.inf if begin is None else begin.since(start),
        math.inf if end is None else end.since(start),
    )


def _start(epoch: str, states: list[MessageState]) -> Epoch:
    """When the time is 0. Raises ValueError where that may be meant in the time system of the message, not in UTC."""
    systems = sorted({state.segment["TIME_SYSTEM"].upper() for state in states} - {"UTC"})
    start = Epoch.of(epoch)
    if systems and named_system(epoch) is None:
        raise ValueError(
            f"delivery.epoch is {epoch}, and the states count in {systems[0]}; say in which time system it is: write "
            f'"{epoch} {systems[0]}" or "{epoch} UTC"'
        )
    return start


def _refuse_segment(state: MessageState, name: str, frame: str, centres: Sequence[str]) -> None:
    """Raise ValueError where a segment says that its states are in other axes, or from another centre."""
    given, centre = state.segment["REF_FRAME"], state.segment["CENTER_NAME"]
    where = f"{name}, line {state.line}"
    if _plain(centre) not in centres:
        raise ValueError(
            f"{where}: CENTER_NAME is {centre}; allowed: {' or '.join(centres)}, as states count from the centre of "
            "the study's body; convert them, or name a mesh by site.name"
        )
    fixed = [form.format(one) for one in centres if not one.isdecimal() for form in FIXED_NAMES]
    known = fixed if frame == "body_fixed" else ICRF_NAMES
    if _plain(given) in known:
        return
    remedy = "write the name that these axes have there"
    if frame == "body_fixed" and _plain(given) in ICRF_NAMES:
        remedy = 'of a delivery write delivery.frame = "icrf"'
    raise ValueError(
        f'{where}: REF_FRAME is {given}, and the states of the study are "{frame}"; allowed: {", ".join(known)}; '
        f"convert the states, or {remedy}"
    )
