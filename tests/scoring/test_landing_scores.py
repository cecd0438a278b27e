"""Predictions of any code against observations: what is scored, and what is refused."""

import math
import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from lithobrake.scoring.landing_scores import LandingScore, even_score, score_lines, scores
from lithobrake.scoring.observed_landing import Measured, ObservedLanding, archive, past_landing, read_observation
from lithobrake.scoring.predicted_landings import PredictedLandings, read_prediction

OBSERVED = """
title = "a lander"
source = "nowhere"
end = "at_rest"
time_s = { value = 600.0, error = 30.0 }
contacts = 4
face = "+z"
place = { latitude_deg = 10.0, longitude_deg = 20.0, radius = 100.0, error = 2.0 }
"""


def observation(folder: Path, text: str = OBSERVED) -> ObservedLanding:
    path = folder / "observed.toml"
    path.write_text(text, encoding="utf-8")
    return read_observation(path)


def prediction(folder: Path, text: str, name: str = "predicted.csv") -> PredictedLandings:
    (folder / name).write_text(text, encoding="utf-8")
    return read_prediction(folder / name)


def table(rows: list[dict[str, object]]) -> str:
    return "\n".join([",".join(rows[0]), *(",".join(map(str, row.values())) for row in rows)]) + "\n"


def sample(scale: float, count: int = 120) -> str:
    generator = np.random.default_rng(5)
    rows: list[dict[str, object]] = []
    for number in range(count):
        latitude, longitude = np.array([10.0, 20.0]) + scale * generator.normal(0.0, 10.0, 2)
        time, contacts = 600.0 * math.exp(scale * generator.normal()), 1 + generator.poisson(3.0 * scale)
        end = "at_rest" if number % 10 else "escaped"
        row = {
            "bed": number // 4,
            "end": end,
            "time_s [s]": time,
            "contacts": contacts,
            "face": "+z-z"[number % 2 :: 2],
        }
        rows.append({**row, "face": ("+z", "-z")[number % 2], "latitude_deg": latitude, "longitude_deg": longitude})
    return table(rows)


def by_quantity(found: list[LandingScore]) -> dict[str, LandingScore]:
    return {one.quantity: one for one in found}


def test_a_sharper_prediction_about_the_observation_scores_better(tmp_path: Path) -> None:
    observed = observation(tmp_path)
    wide, sharp = (by_quantity(scores(prediction(tmp_path, sample(scale)), observed)) for scale in (1.0, 0.3))
    assert set(wide) == {"end", "time_s", "contacts", "place", "face"}
    for name in ("time_s", "place"):
        assert sharp[name].score.upper < wide[name].score.lower
    assert wide["end"].score.value == pytest.approx(-math.log2(108.5 / 122.0))
    # Of 108 at rest 48 lie on the side that was observed, among six that there may be.
    assert wide["face"].score.value == pytest.approx(-math.log2(48.5 / 111.0))
    assert wide["face"].score.value < even_score(6)
    assert wide["time_s"].below == pytest.approx(0.5, abs=0.1)
    for one in wide.values():
        assert one.score.lower <= one.score.value <= one.score.upper


def test_landings_of_unknown_end_widen_the_interval_both_ways(tmp_path: Path) -> None:
    observed = observation(tmp_path, 'end = "at_rest"\n')
    ends = ["at_rest"] * 90 + ["escaped"] * 10
    known = scores(prediction(tmp_path, table([{"end": end} for end in ends])), observed)[0].score
    lost = scores(prediction(tmp_path, table([{"end": end} for end in [*ends, *["failed"] * 20]])), observed)[0].score
    assert lost.value == known.value
    assert lost.bounds is not None
    # At the extremes 90 and 110 of 120 landings.
    assert lost.bounds[0] < -math.log2(110.0 / 120.0) < -math.log2(90.0 / 120.0) < lost.bounds[1]
    assert known.bounds is not None
    assert lost.bounds[0] <= known.bounds[0] < known.bounds[1] < lost.bounds[1]


def test_an_end_that_no_landing_has_scores_at_least_so_much(tmp_path: Path) -> None:
    """Of 60 landings none escapes: the score has a lower limit, by the limit of the share, and no upper one."""
    observed = observation(tmp_path, 'end = "escaped"\n')
    (found,) = scores(prediction(tmp_path, table([{"end": "at_rest"}] * 60)), observed)
    assert found.score.upper is None
    assert found.score.lower == pytest.approx(-math.log2(1.0 - 0.1 ** (1 / 60)), abs=0.01)
    assert "(at least 4.7" in score_lines([found])[1]
    all_alike = scores(prediction(tmp_path, table([{"end": "escaped"}] * 60)), observed)[0].score
    assert all_alike.bounds is not None
    assert all_alike.bounds[0] == 0.0
    assert all_alike.bounds[1] == pytest.approx(-math.log2(0.1 ** (1 / 60)), abs=0.01)


def test_one_bed_has_no_interval(tmp_path: Path) -> None:
    rows = [{"bed": 3, "end": "at_rest", "time_s": time} for time in (100.0, 200.0, 400.0)]
    found = scores(prediction(tmp_path, table(rows)), observation(tmp_path))
    assert [one.score.bounds for one in found] == [None, None]
    assert all(one.score.why_missing for one in found)
    assert "(no interval: " in score_lines(found)[1]


def test_landings_without_weight_are_none(tmp_path: Path) -> None:
    observed = observation(tmp_path)
    text = "end,weight,time_s\nat_rest,0,10\nat_rest,0,20\nescaped,1,\nescaped,1,\n"
    found = scores(prediction(tmp_path, text), observed)
    assert [(one.quantity, one.sample_count) for one in found] == [("end", 2)]
    with pytest.raises(ValueError, match="the end of none of the 2 landings is known"):
        prediction(tmp_path, "end,weight\nat_rest,0\nfailed,1\n")


@pytest.mark.parametrize(("groups", "each"), [(12, 1), (24, 5)])
def test_intervals_of_a_score_hold_the_score_of_the_distribution(
    scoringrules: ModuleType, groups: int, each: int
) -> None:
    """Normal times, observed one standard deviation off: 90 % of 300 intervals hold the closed form."""
    generator, held = np.random.default_rng(7), 0
    score = 100.0 * float(scoringrules.crps_normal(1.0, 0.0, 1.0))
    observed = ObservedLanding("", "", "at_rest", {"time_s": Measured(700.0, 0.0)})
    count = groups * each
    for _ in range(300):
        sample = PredictedLandings(
            "", np.full(count, "at_rest"), np.ones(count), np.repeat(np.arange(groups), each),
            {"time_s": generator.normal(600.0, 100.0, count)}, np.full(count, ""), np.full((count, 3), np.nan),
        )  # fmt: skip
        bounds = scores(sample, observed)[1].score.bounds
        held += bounds is not None and bounds[0] <= score <= bounds[1]
    assert 0.86 <= held / 300 <= 0.95


def test_landings_of_one_bed_are_one_observation(tmp_path: Path) -> None:
    """The interval of landings that are copies of 20 is as wide as that of the 20."""
    observed, generator = observation(tmp_path, OBSERVED.split("contacts")[0]), np.random.default_rng(2)
    rows = [{"bed": bed, "end": "at_rest", "time_s": time} for bed, time in enumerate(generator.gamma(3.0, 200.0, 20))]
    alone, copied = (
        by_quantity(scores(prediction(tmp_path, table(rows * times)), observed))["time_s"].score for times in (1, 8)
    )
    assert alone.bounds is not None
    assert copied.bounds is not None
    assert copied.bounds[1] - copied.bounds[0] == pytest.approx(alone.bounds[1] - alone.bounds[0], rel=0.2)


def test_a_box_that_names_its_axis_alone_lies_on_either_side(tmp_path: Path) -> None:
    observed = observation(tmp_path, 'end = "at_rest"\nface = "+z"\n')
    found = [
        by_quantity(scores(prediction(tmp_path, table([{"end": "at_rest", "face": face} for face in faces])), observed))
        for faces in (["z"] * 10, ["+z", "-z"] * 5)
    ]
    assert found[0]["face"].score.value == pytest.approx(found[1]["face"].score.value)


def test_every_landing_of_the_archive_is_an_observation() -> None:
    assert {"mascot", "philae", "minerva", "minerva_ii_1a"} <= set(archive())
    for name, entry in archive().items():
        observed = past_landing(name)
        assert observed.title
        assert observed.source
        assert {"lander", "body", "date", "observed"} <= set(entry)
    philae = past_landing("philae")
    assert (philae.end, philae.numbers["contacts"].value, philae.numbers["time_s"].error) == ("at_rest", 4.0, 42.0)
    assert past_landing("minerva").end == "escaped"


@pytest.mark.parametrize(("text", "said"), [
    ('end = "rest"\n', 'end is "rest"; allowed: at_rest, escaped, partner, under_way; change it'),
    ("contacts = 4\n", "end is missing; allowed: at_rest"),
    ('end = "at_rest"\ntime = 3\n', '"time" is no key; did you mean time_s?; allowed: title'),
    ('end = "at_rest"\ntime_s = -1\n', "time_s is -1; allowed: a number from 0 to 1e+09; change it"),
    ('end = "at_rest"\ntime_s = nan\n', "time_s is nan; allowed: a number from 0"),
    ('end = "at_rest"\ntime_s = { value = 3, sigma = 1 }\n', "sigma = 1 }; allowed: a number, or"),
    ('end = "at_rest"\ncontacts = true\n', "contacts is true; allowed: a number from 0"),
    ('end = "at_rest"\nface = "z"\n', 'face is "z"; allowed: +x, -x'),
    ('end = "at_rest"\nplace = { latitude_deg = 1.0 }\n', "place is { latitude_deg = 1 }; allowed: a table of"),
    ('end = "at_rest"\nplace = { latitude_deg = 91, longitude_deg = 0, radius = 1, error = 0 }\n', "deg is 91"),
    ('end = "at_rest"\nplace = { latitude_deg = 9, longitude_deg = 0, radius = 0, error = 0 }\n', "radius is 0 m"),
    ("end = at_rest\n", "is no TOML"),
], ids=str)  # fmt: skip
def test_an_observation_that_is_none_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        observation(tmp_path, text)


@pytest.mark.parametrize(("text", "said"), [
    ("time_s\n5\n", "lacks the columns end"),
    ("end\n", "has no landings"),
    ("end\nfailed\nfailed\n", "the end of none of the 2 landings is known"),
    ("end\nresting\n", 'row 1: end is "resting"; allowed: at_rest, escaped, partner, under_way, failed'),
    ("end,time_s\nat_rest,soon\n", 'row 1: time_s is "soon"; allowed: a number from 0, or nothing'),
    ("end,time_s\nat_rest,-4\n", "row 1: time_s is"),
    ("end,latitude_deg\nat_rest,95\n", "allowed: a number from -90 to 90"),
    ("end,weight\nat_rest,0\n", "weight is empty in a row, or 0 in all"),
    ("end,weight\nat_rest,\n", "weight is empty in a row, or 0 in all"),
    ("end,face\nat_rest,top\n", 'face is "top"; allowed: +x'),
], ids=str)  # fmt: skip
def test_a_prediction_that_is_none_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        prediction(tmp_path, text)


def test_more_landings_than_all_pairs_of_which_can_be_compared_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"has 5001 landings; allowed: at most 5000; give a random part"):
        scores(prediction(tmp_path, "end\n" + "at_rest\n" * 5001), observation(tmp_path))


def test_what_the_sample_does_not_have_is_left_out(tmp_path: Path) -> None:
    found = scores(prediction(tmp_path, "end\nat_rest\nescaped\n"), observation(tmp_path))
    assert [one.quantity for one in found] == ["end"]
