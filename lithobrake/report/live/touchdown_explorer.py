"""The explorer of a study of journeys: one touchdown, as the emulator of all touchdowns has it."""

import numpy as np

from lithobrake.report.content import LiveSection
from lithobrake.report.live.explorer import emulator_bands, explorer_section, law_facts
from lithobrake.report.page_data import JourneyPage
from lithobrake.report.words.captions import input_words, listing, thousands
from lithobrake.report.words.numbers import number
from lithobrake.results import ExplorerTables, Table
from lithobrake.vocabulary.quantities import GROUND

# What differs from touchdown to touchdown, in the order in which the page says it; the first one by its logarithm.
SPEED = "impact.speed"
OF_TOUCHDOWN = (SPEED, "impact.incidence_deg", *GROUND[:2])


def touchdown_sections(data: JourneyPage) -> list[LiveSection]:
    """The explorer with all its numbers; none where the touchdowns have no emulator."""
    explorer = data.explorer
    if explorer is None:
        return []
    outcomes = data.touchdowns["outcome"]
    fitted = data.touchdowns.where(np.isin(outcomes, explorer.outcome_names))
    beds = len(np.unique(fitted["bed"]))
    # Refits draw runs where those that left lie on one bed.
    over_beds = 1 < beds == explorer.group_count
    moved = [name for name in explorer.input_names if name not in explorer.attitude_inputs]
    facts = law_facts(explorer, moved, fitted) | {
        # Of all touchdowns that are drawn, those that are captured.
        "ofAll": True,
        "holds": True,
        "action": "come to rest at this touchdown",
        "reach": explorer.interval_reach if over_beds else None,
    }
    note = f"{_what(fitted, beds)} {_law(explorer)} {emulator_bands(explorer, over_beds)} "
    return [explorer_section(note, facts, explorer)]


def _what(fitted: Table, beds: int) -> str:
    """What is evaluated, and over which range it is known."""
    ranges = listing([_range(fitted, name) for name in OF_TOUCHDOWN])
    return (
        "Any touchdown of a journey: move the two ends of an input range, and this page evaluates the emulator of all "
        "touchdowns over it. The emulator was fitted to "
        f"{thousands(fitted.row_count)} touchdowns on {beds} {'bed' if beds == 1 else 'beds'}, with {ranges}; the "
        "sliders extend to the end of its training range."
    )


def _range(fitted: Table, name: str) -> str:
    """The range of an input, "speed at impact from 0.01 to 0.08 m/s"."""
    low, high = (number(float(end), 2) for end in (fitted[name].min(), fitted[name].max()))
    return f"{input_words(name)} from {low} to {high} {fitted.columns[name].units}"


def _law(explorer: ExplorerTables) -> str:
    """What the inputs are drawn from, and what no slider moves."""
    even = listing([input_words(name) for name in OF_TOUCHDOWN if name != SPEED])
    attitude = "Attitudes are uniform over all rotations, or have one side toward the ground; s"
    attitude = attitude if explorer.attitude else "S"
    named = {*OF_TOUCHDOWN, *explorer.attitude_inputs}
    others = "Soil and lander follow their input distributions; " if set(explorer.input_names) - named else ""
    words = (
        f"{others}the logarithm of {input_words(SPEED)}, {even} are uniform over their ranges, independently of the "
        f"number of touchdowns there. {attitude}pin and bed are part of the scatter."
    )
    return f"{words[:1].upper()}{words[1:]}"
