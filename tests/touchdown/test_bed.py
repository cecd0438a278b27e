"""Grains, pouring, settling, and the file of a bed; the library, where what was poured once is found again."""

import json
import logging
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from decimal import Decimal, localcontext
from pathlib import Path

import numpy as np
import pytest

from lithobrake.dem import Sphere, StepTooLargeError, World
from lithobrake.touchdown import Bed, ContactModel, GrainSizes, pour_bed, pouring, settling, stored_or_poured
from lithobrake.touchdown import bed_library as module
from lithobrake.touchdown.bed import height_map
from lithobrake.touchdown.grains import make_grain

from .landings import ROCK


def test_sizes_follow_their_distribution():
    uniforms = (np.arange(100_000) + 0.5) / 100_000
    power = GrainSizes(distribution="power_law", lower=0.1, upper=0.4, exponent=3.5).draw(uniforms)
    assert power.min() >= 0.1
    assert power.max() <= 0.4
    # Share below the middle of N(d) ~ d^-3.5 between 0.1 and 0.4.
    share = (0.1**-2.5 - 0.2**-2.5) / (0.1**-2.5 - 0.4**-2.5)
    assert (power < 0.2).mean() == pytest.approx(share, abs=1e-4)
    normal = GrainSizes(distribution="normal", lower=0.05, upper=0.15, mean=0.1, std=0.01).draw(uniforms)
    assert (normal.mean(), normal.std()) == (pytest.approx(0.1, abs=1e-5), pytest.approx(0.01, rel=1e-3))
    assert np.all(GrainSizes(distribution="constant", lower=0.1, upper=0.1).draw(uniforms) == 0.1)


@pytest.mark.parametrize("exponent", [0.0, 0.5, 1.0 - 1e-9, 1.0, 1.000000000000001, 1.0 + 1e-9, 2.5, 30.0, 1e3, 1e300])
def test_power_laws_keep_their_digits_at_every_exponent(exponent):
    """N(<d) = (d^p - lower^p) / (upper^p - lower^p) with p = 1 - exponent, in digits enough for any of them."""
    uniforms = np.array([0.0, 0.1, 0.5, 0.9, 1.0 - 1e-12])
    found = GrainSizes(distribution="power_law", lower=0.01, upper=0.1, exponent=exponent).draw(uniforms)
    with localcontext(prec=60):
        # 0.01 and 0.1 as floats hold them.
        low, high = (Decimal.from_float(diameter) for diameter in (0.01, 0.1))
        power, ratio = 1 - Decimal.from_float(exponent), high / low
        parts = [Decimal(u) for u in uniforms.tolist()]
        wanted = [float(low * (ratio**u if power == 0 else (1 + u * (ratio**power - 1)) ** (1 / power))) for u in parts]
    assert found == pytest.approx(wanted, rel=1e-14)


def test_the_mean_diameter_is_that_of_the_law():
    # Mean of d^-3 between 1 and 2: 2 (1 - 1/2) / (1 - 1/4).
    assert GrainSizes(distribution="power_law", lower=1.0, upper=2.0, exponent=3.0).mean_diameter == pytest.approx(
        4.0 / 3.0, rel=1e-6
    )
    assert GrainSizes(distribution="constant", lower=0.1, upper=0.1).mean_diameter == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("wrong", [
    {"distribution": "gamma", "lower": 0.1, "upper": 0.2},
    {"distribution": "constant", "lower": 0.1, "upper": 0.2},
    {"distribution": "uniform", "lower": 0.2, "upper": 0.1},
    {"distribution": "normal", "lower": 0.1, "upper": 0.2},
    {"distribution": "power_law", "lower": 0.1, "upper": 0.2},
    {"distribution": "power_law", "lower": 0.1, "upper": 0.2, "exponent": -2.5},
    {"distribution": "power_law", "lower": 0.1, "upper": 0.2, "exponent": -500.0},
    {"distribution": "power_law", "lower": 0.1, "upper": 0.2, "exponent": float("nan")},
    {"distribution": "normal", "lower": 0.1, "upper": 0.2, "mean": float("nan"), "std": 0.1},
    {"distribution": "normal", "lower": 0.1, "upper": 0.2, "mean": 1e300, "std": 0.1},
    {"distribution": "normal", "lower": 0.1, "upper": 0.2, "mean": 0.15, "std": float("nan")},
])  # fmt: skip
def test_wrong_sizes_are_refused(wrong):
    with pytest.raises(ValueError, match=r"GrainSizes\."):
        GrainSizes(**wrong)


def test_grain_has_the_volume_of_its_sphere_and_its_centroid_at_the_origin():
    grain = make_grain(np.random.default_rng(1), 14, 0.1)
    assert grain.volume == pytest.approx(np.pi / 6 * 1e-3, rel=1e-12)
    assert np.abs(grain.centroid).max() < 1e-16


def test_bed_is_at_rest_in_its_box(bed):
    assert bed.history["kinetic_ratio"][-1] < settling.KINETIC_RATIO
    assert bed.history["unbalanced_force"][-1] < settling.UNBALANCED_FORCE
    assert (bed.history["gravity"][-1], bed.history["gravity"][0]) == (pytest.approx(5e-4), pytest.approx(0.5))
    assert np.abs(bed.position[:, :2]).max() < 0.18
    assert bed.position[:, 2].min() > 0.0
    assert 0.4 < bed.solid_fraction < 0.8
    assert bed.coordination_number > 2.5
    assert 0.09 < bed.surface_height < bed.surface_top
    assert len(bed.frames["time"]) > 4


def test_gravity_is_raised_to_a_rung_for_what_falls_and_comes_down_again(bed):
    """Pour, local gravity while the pressure is let out, a hundred times that for what falls, then the local one."""
    gravity = bed.history["gravity"]
    stages = gravity[np.concatenate([[True], ~np.isclose(gravity[1:], gravity[:-1])])]
    assert stages == pytest.approx([0.5, 5e-4, 0.05, 5e-4])


def test_quiet_steps_fill_their_time_and_stay_below_the_largest_safe_one(bed, recipe):
    world = bed.world(recipe().material, bed.gravity, recipe().contact)
    period = settling.rest_period(recipe().material, bed.grain_diameter, 5e-4)
    for _ in range(40):
        before = world.time
        settling.run_quietly(world, 0.05 * period)
        assert world.time - before == pytest.approx(0.05 * period, rel=1e-9)
        assert world.time_step < world.largest_step


def test_floor_and_contacts_carry_the_weight(bed, recipe):
    """The sum of all forces on the floor is the weight of the grains, to the balance that counts as rest."""
    rock = recipe().material
    world = bed.world(rock, bed.gravity, recipe().contact)
    period = settling.rest_period(rock, bed.grain_diameter, 5e-4)
    world.drag = 1.0 / period
    assert settling.rests(world, period, 5.0, lambda: settling.unbalanced_force(world) < 1e-2)
    contacts = world.contacts()
    up = np.zeros(3)
    for row in contacts[contacts["body_b"] < 0]:
        up -= row["normal_force"] * row["normal"] + row["tangential_force"]
    weight = world.mass.sum() * 5e-4
    assert up[2] == pytest.approx(weight, rel=0.02)
    assert np.abs(up[:2]).max() < 0.02 * weight


def test_rest_period_is_that_of_the_linearised_contact():
    """VALIDATION: 0.13 s at E = 1e8 and 0.6 s at 1e6, for 0.1 m grains at 5e-5 m/s2."""
    assert settling.rest_period(replace(ROCK, young_modulus=1e8), 0.1, 5e-5) == pytest.approx(0.13, abs=0.01)
    assert settling.rest_period(ROCK, 0.1, 5e-5) == pytest.approx(0.6, abs=0.02)


def test_bed_survives_its_file(bed, tmp_path):
    bed.save(tmp_path / "bed.h5")
    other = Bed.load(tmp_path / "bed.h5")
    assert np.array_equal(bed.position, other.position)
    assert np.array_equal(bed.orientation, other.orientation)
    assert all(np.array_equal(a.core, b.core) for a, b in zip(bed.grains, other.grains, strict=True))
    assert (other.width, other.seed) == (bed.width, bed.seed)
    assert np.array_equal(bed.frames["position"], other.frames["position"])


def test_same_seed_same_bits_other_seed_other_bed(recipe):
    first, again, other = (pour_bed(recipe(seed=seed, grain_count=8, width=(0.25, 0.25))) for seed in (6, 6, 7))
    assert np.array_equal(first.position, again.position)
    assert not np.array_equal(first.position, other.position)


def test_a_bed_in_which_a_grain_creeps_on_is_poured_anew(recipe, monkeypatch):
    few, poured = recipe(grain_count=6, width=(0.24, 0.24)), []

    def creeping_at_first(of, generator, tell):
        poured.append(generator.random())
        if len(poured) < 3:
            raise settling.CreepingBedError("a grain creeps on")
        return of

    monkeypatch.setattr(pouring, "_poured", creeping_at_first)
    assert pour_bed(few) is few
    # Every pour has random numbers of its own, the first those of the seed alone.
    assert len(set(poured)) == pouring.POURS == 3
    assert poured[0] == np.random.default_rng(few.seed).random()
    poured.clear()
    monkeypatch.setattr(pouring, "POURS", 2)
    with pytest.raises(ValueError, match="a grain creeps on"):
        pour_bed(few)


@pytest.mark.parametrize(("weaker", "strength"), [(1e-3, "0.0005"), (np.inf, "0.05")])
def test_a_bed_that_does_not_rest_once_its_grains_lie_is_said_to_creep(recipe, monkeypatch, weaker, strength):
    rests = settling.rests

    def never_below(world, period, periods_held, at_rest, each_check=lambda held: None):
        below = np.linalg.norm(world.gravity) < weaker
        return False if below else rests(world, period, periods_held, at_rest, each_check)

    monkeypatch.setattr(settling, "rests", never_below)
    monkeypatch.setattr(pouring, "POURS", 1)
    said = f"did not come to rest within 1200 periods of a grain's small oscillation under {strength} m/s2"
    with pytest.raises(settling.CreepingBedError, match=said):
        pour_bed(recipe(grain_count=6, width=(0.24, 0.24)))


def test_height_map_sees_the_top_of_every_grain(bed):
    heights = height_map(bed.grains, bed.position, bed.orientation, bed.width)
    assert heights.max() <= bed.surface_top + 1e-12
    assert heights.max() > 0.1
    one = height_map(bed.grains[:1], np.array([[0, 0, 5.0]]), np.array([[1.0, 0, 0, 0]]), (0.4, 0.4))
    assert one.max() == pytest.approx(5.0 + bed.grains[0].vertices[:, 2].max(), abs=0.02)
    assert (one == 0.0).any()


@pytest.mark.parametrize(("name", "value"), [
    ("grain_count", 0),
    ("cloud_point_count", 3),
    ("width", (0.1, 0.4)),
    ("gravity", (0, 0, 1e-4)),
    ("pour_gravity", 1e-5),
])  # fmt: skip
def test_impossible_recipes_are_refused(recipe, name, value):
    with pytest.raises(ValueError, match=f"BedRecipe.{name}"):
        recipe(**{name: value})


def test_a_grain_that_meets_another_hard_makes_the_steps_smaller_and_is_not_refused():
    worlds = World(), World(), World()
    for world in worlds:
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
        world.add_body(Sphere(0.05), ROCK, (0.0, 0.0, 0.0501), (0.0, 0.0, -0.05))
    world, other, last = worlds
    chunk = 0.8 * world.shortest_contact(0.05)
    world.time_step = chunk / 4.0
    with pytest.raises(StepTooLargeError, match="make it smaller"):
        world.run(steps=4)
    for _ in range(10):
        settling.run_quietly(other, chunk)
    assert other.time == pytest.approx(10.0 * chunk, rel=1e-12)
    assert other.velocity[0, 2] == pytest.approx(0.5 * 0.05, rel=0.04)
    with pytest.raises(StepTooLargeError, match="make it smaller"):
        settling.run_quietly(last, 3.0 * chunk)


@pytest.fixture
def library(tmp_path, monkeypatch):
    """The folder of an empty library of a megabyte."""
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("LITHOBRAKE_BED_LIBRARY_GB", "0.001")
    module._library.cache_clear()
    yield tmp_path / "cache" / "lithobrake" / "beds"
    module._library.cache_clear()


def kept(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if not path.name.startswith("lock"))


def never() -> Bed:
    raise AssertionError("the bed was in the library")


def test_a_bed_that_was_poured_is_found_again_bit_for_bit(library, recipe, tmp_path):
    # A pour of its own: the bed of the other tests is not asked how it was poured.
    few = recipe(grain_count=4, width=(0.25, 0.25))
    assert stored_or_poured(few, tmp_path / "first.h5", lambda: pour_bed(few))
    assert kept(library) == [module.bed_key(few)]
    assert not stored_or_poured(few, tmp_path / "second.h5", never)
    assert (tmp_path / "first.h5").read_bytes() == (tmp_path / "second.h5").read_bytes()
    found, again = Bed.load(tmp_path / "second.h5"), pour_bed(few)
    assert found.position.tobytes() == again.position.tobytes()
    assert found.orientation.tobytes() == again.orientation.tobytes()
    assert found.seed == few.seed


def test_the_key_holds_what_a_bed_follows_from_and_nothing_else(recipe, monkeypatch):
    first = recipe()
    others = [recipe(seed=4), recipe(grain_count=25), recipe(pour_gravity=0.6), recipe(gravity=(0.0, 0.0, -6e-4)),
        recipe(material=replace(first.material, friction=0.6)), recipe(contact=ContactModel(steps_per_contact=26.0)),
        recipe(sizes=replace(first.sizes, upper=0.12)), recipe(sides="periodic")]  # fmt: skip
    assert len({module.bed_key(one) for one in (first, *others)}) == 9
    assert module.bed_key(recipe()) == module.bed_key(first)
    # How a landing is stepped changes no bed.
    assert module.bed_key(recipe(contact=replace(first.contact, stepping="local"))) == module.bed_key(first)
    before = module.bed_key(first)
    monkeypatch.setattr(module, "_code", lambda: ["edited"])
    assert module.bed_key(first) != before


@pytest.mark.parametrize("damage", [lambda whole: whole[:-40], lambda whole: b"x" + whole[1:], lambda whole: b""])
def test_a_damaged_bed_is_poured_anew_with_a_word(library, recipe, bed, tmp_path, caplog, damage):
    stored_or_poured(recipe(), tmp_path / "first.h5", lambda: bed)
    (name,) = kept(library)
    whole = (library / name).read_bytes()
    (library / name).write_bytes(damage(whole))
    with caplog.at_level(logging.WARNING):
        assert stored_or_poured(recipe(), tmp_path / "second.h5", lambda: bed)
    assert f"{library / name} is damaged, or was not written with this user's key: it is made again." in caplog.messages
    assert (library / name).read_bytes()[:-32] == (tmp_path / "second.h5").read_bytes()
    assert not stored_or_poured(recipe(), tmp_path / "third.h5", never)


def test_the_beds_that_were_unused_for_longest_make_room(library, recipe, bed, tmp_path, monkeypatch):
    def ask(seed: int) -> bool:
        return stored_or_poured(recipe(seed=seed), tmp_path / f"{seed}.h5", lambda: bed)

    assert ask(1)
    size = (library / module.bed_key(recipe(seed=1))).stat().st_size
    monkeypatch.setenv("LITHOBRAKE_BED_LIBRARY_GB", str(3.5 * size / 1e9))
    # A draft that a process left behind when it was killed counts, one that is being written does not.
    old, new = f".{'0' * 64}.1.part", f".{'0' * 64}.2.part"
    for name, age in ((old, 2e5), (new, 0.0)):
        (library / name).write_bytes(b"0" * size)
        os.utime(library / name, (time.time() - age,) * 2)
    for seed in (2, 3):
        assert ask(seed)
    # Used again, the first is no longer the one that was unused for longest.
    for seed, age in ((1, 30.0), (2, 20.0), (3, 10.0)):
        os.utime(library / module.bed_key(recipe(seed=seed)), (time.time() - age,) * 2)
    assert not ask(1)
    assert ask(4)
    assert kept(library) == sorted([new, *(module.bed_key(recipe(seed=seed)) for seed in (1, 3, 4))])
    assert all((tmp_path / f"{seed}.h5").is_file() for seed in (1, 2, 3, 4))


@pytest.mark.parametrize("size", ["0", "1e-9"])
def test_a_library_without_room_keeps_nothing_and_pours(library, recipe, bed, tmp_path, monkeypatch, size):
    monkeypatch.setenv("LITHOBRAKE_BED_LIBRARY_GB", size)
    for _ in range(2):
        assert stored_or_poured(recipe(), tmp_path / "bed.h5", lambda: bed)
    assert not library.exists() or kept(library) == []
    assert Bed.load(tmp_path / "bed.h5").position.tobytes() == bed.position.tobytes()


def test_without_a_library_no_bed_of_it_is_taken(library, recipe, bed, tmp_path, monkeypatch):
    stored_or_poured(recipe(), tmp_path / "bed.h5", lambda: bed)
    monkeypatch.setenv("LITHOBRAKE_BED_LIBRARY_GB", "0")
    assert stored_or_poured(recipe(), tmp_path / "bed.h5", lambda: bed)


@pytest.mark.parametrize("size", ["much", "-1", "nan", "inf", "1e300"])
def test_a_size_that_is_none_is_refused(library, recipe, tmp_path, monkeypatch, size):
    monkeypatch.setenv("LITHOBRAKE_BED_LIBRARY_GB", size)
    with pytest.raises(ValueError, match=f"LITHOBRAKE_BED_LIBRARY_GB is '{size}'; allowed: 1e.09 gigabytes"):
        stored_or_poured(recipe(), tmp_path / "bed.h5", never)


# A process that asks for beds of a recipe, again and again, and pours, slowly, what lies in a file.
PROCESS = """
import json, pickle, sys, time
from dataclasses import replace
from pathlib import Path
from lithobrake.touchdown import Bed, stored_or_poured
home = Path(sys.argv[1])
bed, recipe = Bed.load(home / "ready.h5"), pickle.loads((home / "recipe").read_bytes())
for line in sys.stdin:
    seed, name, seconds = json.loads(line)

    def pour():
        (home / f"started_{seed}").touch()
        time.sleep(seconds)
        return bed

    print(json.dumps(stored_or_poured(replace(recipe, seed=seed), home / name, pour)), flush=True)
"""


@pytest.fixture(scope="module")
def home(bed, recipe, tmp_path_factory):
    """The folder of two processes, with a library of their own."""
    place = tmp_path_factory.mktemp("processes")
    bed.save(place / "ready.h5")
    (place / "recipe").write_bytes(pickle.dumps(recipe()))
    return place


@pytest.fixture(scope="module")
def processes(home):
    """Two that have one library and are asked for beds."""
    environment = os.environ | {"LITHOBRAKE_CACHE": str(home / "cache"), "LITHOBRAKE_BED_LIBRARY_GB": "0.001"}
    words = [sys.executable, "-c", PROCESS, str(home)]
    both = [
        subprocess.Popen(words, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    yield both
    for one in both:
        one.kill()
        one.communicate()


def ask(one: "subprocess.Popen[str]", seed: int, name: str, seconds: float) -> None:
    """Ask for the bed of a seed in a file of this name, which takes so many seconds to pour."""
    one.stdin.write(json.dumps([seed, name, seconds]) + "\n")
    one.stdin.flush()


def answer(one: "subprocess.Popen[str]") -> bool:
    late = threading.Timer(60.0, one.kill)
    late.start()
    line = one.stdout.readline()
    late.cancel()
    return bool(json.loads(line))


def wait_for(path: Path) -> None:
    for _ in range(3000):
        if path.exists():
            return
        time.sleep(0.01)
    raise AssertionError(f"{path} did not come")


def test_of_two_processes_one_pours_and_the_other_waits_for_it(processes, home):
    # Both have begun once they have answered, and are asked together.
    for number, one in enumerate(processes):
        ask(one, 10 + number, "first.h5", 0.0)
    assert [answer(one) for one in processes] == [True, True]
    for number, one in enumerate(processes):
        ask(one, 7, f"out_{number}.h5", 0.5)
    assert sorted(answer(one) for one in processes) == [False, True]
    assert (home / "out_0.h5").read_bytes() == (home / "out_1.h5").read_bytes()


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such locks")
def test_a_process_that_dies_while_it_pours_leaves_its_turn_to_the_next(processes, home):
    first, second = processes
    ask(first, 8, "lost.h5", 600.0)
    wait_for(home / "started_8")
    ask(second, 8, "next.h5", 0.0)
    first.send_signal(signal.SIGKILL)
    assert answer(second)
    assert (home / "next.h5").is_file()
