"""The delivery that the how-to makes from a trajectory of SPICE, with kernels of the test in place of a mission's."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import StudySource

from ..pipeline.journeys.bouncing_lander import journey_tables
from ..smallbody.kernels import write_kernels

spice: Any = pytest.importorskip("spiceypy")
PAGE = Path(__file__).parents[2] / "docs" / "howto" / "delivery_from_spk.md"
EPOCH, COUNT, CRAFT, BODY = "2026-10-01T06:00:00", 24, -999, 920065803
RADIUS, PASS_SPEED = 1.4, 2e-4  # km, km/s: a straight pass above the equator


def write_trajectory(folder: Path) -> None:
    """An SPK along the axes of the ecliptic, as planners write them."""
    folder.mkdir(exist_ok=True)
    middle = spice.str2et(EPOCH)
    times = middle + np.linspace(-7200.0, 7200.0, 241)
    pole = np.array([math.cos(math.radians(-72.725)) * math.cos(math.radians(69.327)),
                     math.cos(math.radians(-72.725)) * math.sin(math.radians(69.327)),
                     math.sin(math.radians(-72.725))])  # fmt: skip
    above = np.cross(pole, [0.0, 0.0, 1.0])
    above /= np.linalg.norm(above)
    states = np.empty((len(times), 6))
    states[:, :3] = RADIUS * above + PASS_SPEED * (times - middle)[:, None] * np.cross(pole, above)
    states[:, 3:] = PASS_SPEED * np.cross(pole, above)
    turn = np.array(spice.pxform("J2000", "ECLIPJ2000", middle))
    states = np.ascontiguousarray(np.hstack([states[:, :3] @ turn.T, states[:, 3:] @ turn.T]))
    handle = spice.spkopn(str(folder / "craft.bsp"), "test", 0)
    spice.spkw09(handle, CRAFT, BODY, "ECLIPJ2000", times[0], times[-1], "pass", 3, len(times), states, times)
    spice.spkcls(handle)


@pytest.fixture
def printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[dict[str, float]]:
    """What the block of the page prints, by key, run in a folder with kernels of a test."""
    write_kernels(tmp_path)
    spice.furnsh(str(tmp_path / "leap.tls"))
    write_trajectory(tmp_path)
    text = PAGE.read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    kernels = text[text.index("KERNELS = [") : text.index("CRAFT, BODY")]
    ours = 'KERNELS = ["leap.tls", "didymos.tpc", "craft.bsp"]\n'
    for shown, used in ((kernels, ours), ("-658030", str(BODY)), ("2027-06-05T04:25:34", EPOCH)):
        assert shown in text
        text = text.replace(shown, used)
    monkeypatch.chdir(tmp_path)
    exec(compile(text, str(PAGE), "exec"), {})
    lines = [line.split(" = ") for line in capsys.readouterr().out.splitlines()]
    yield {key: float(value) for key, value in lines}
    spice.kclear()


def test_planned_states_arrive_where_spice_has_them(tmp_path: Path, printed: dict[str, float]) -> None:
    """Body-fixed starts are those of SPICE to 1 mm and 1 um/s, and the landers come down on Didymos."""
    states = np.loadtxt(tmp_path / "release.csv", delimiter=",", skiprows=1)
    assert states.shape == (COUNT, 7)
    assert np.ptp(states[:, 0]) > 60.0
    tables = journey_tables(
        site={"body": "didymos", "partner_longitude_deg": 90.0, **printed}, journey={"count": COUNT},
        delivery={"states": str(tmp_path / "release.csv"), "frame": "icrf", "epoch": EPOCH},
    )  # fmt: skip
    for key in ("heading_deg", "speed", "incidence_deg"):
        del tables["delivery"][key]
    flights = DrawnDesign(with_site_gravity(StudySource.of_tables(tables).study)).descents.flights
    epoch = spice.str2et(EPOCH)
    rate = 2.0 * math.pi / printed["spin_period"]
    for number, (late, *state) in enumerate(states.tolist()):
        turn = np.array(spice.tipbod("J2000", BODY, epoch + late))
        place, velocity = turn @ state[:3], turn @ state[3:]
        velocity -= np.cross([0.0, 0.0, rate], place)
        assert flights.start.position[number] == pytest.approx(place, abs=1e-3)
        assert flights.start.velocity[number] == pytest.approx(velocity, abs=1e-6)
    assert (flights.status == "impact").all()
    assert np.linalg.norm(flights.position, axis=1) == pytest.approx(400.0, abs=50.0)
