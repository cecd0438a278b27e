"""The library of beds: what was poured once is found again, whole, by whoever asks, and within its size."""

import json
import logging
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from lithobrake.touchdown import Bed, ContactModel, pour_bed, stored_or_poured
from lithobrake.touchdown import bed_library as module


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


def test_another_seed_pours_another_bed_and_the_same_seed_the_same(recipe):
    few = recipe(grain_count=4, width=(0.25, 0.25))
    beds = [pour_bed(replace(few, seed=seed)) for seed in (1, 1, 2)]
    assert beds[0].position.tobytes() == beds[1].position.tobytes()
    assert beds[0].position.tobytes() != beds[2].position.tobytes()


def test_the_key_holds_what_a_bed_follows_from_and_nothing_else(recipe, monkeypatch):
    first = recipe()
    others = [
        recipe(seed=4), recipe(grain_count=25), recipe(pour_gravity=0.6), recipe(gravity=(0.0, 0.0, -6e-4)),
        recipe(material=replace(first.material, friction=0.6)), recipe(contact=ContactModel(steps_per_contact=26.0)),
        recipe(sizes=replace(first.sizes, upper=0.12)), recipe(sides="periodic"),
    ]  # fmt: skip
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
    told = f"{library / name} is damaged, or was not written with this user's key: it is made again."
    assert told in caplog.messages
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


# A process that asks for the bed of a seed and pours, slowly, what lies in a file.
PROCESS = """
import json, sys, time
from pathlib import Path
sys.path.insert(0, {tests!r})
from touchdown.conftest import small_recipe
from lithobrake.touchdown import Bed, stored_or_poured
bed = Bed.load({bed!r})

def pour():
    Path({started!r}).touch()
    time.sleep(float(sys.argv[2]))
    return bed

print("ready", flush=True)
sys.stdin.readline()
print(json.dumps(stored_or_poured(small_recipe(seed=7), Path(sys.argv[1]), pour)))
"""


@pytest.fixture
def process(library, bed, tmp_path):
    """Start a process that waits for a word and then asks for a bed, which takes so many seconds to pour."""
    bed.save(tmp_path / "ready.h5")
    started = tmp_path / "started"
    script = PROCESS.format(tests=str(Path(__file__).parents[1]), bed=str(tmp_path / "ready.h5"), started=str(started))
    running = []

    def start(number: int, seconds: float) -> "subprocess.Popen[str]":
        words = [sys.executable, "-c", script, str(tmp_path / f"out_{number}.h5"), str(seconds)]
        one = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        running.append(one)
        assert one.stdout.readline() == "ready\n"
        return one

    yield start
    for one in running:
        one.kill()
        one.communicate()


def ask(one: "subprocess.Popen[str]") -> None:
    one.stdin.write("\n")
    one.stdin.flush()


def answer(one: "subprocess.Popen[str]") -> bool:
    return bool(json.loads(one.communicate(timeout=60)[0]))


def wait_for(path: Path) -> None:
    for _ in range(3000):
        if path.exists():
            return
        time.sleep(0.01)
    raise AssertionError(f"{path} did not come")


def test_of_two_processes_one_pours_and_the_other_waits_for_it(process, tmp_path):
    both = [process(number, 0.5) for number in (1, 2)]
    for one in both:
        ask(one)
    assert sorted(answer(one) for one in both) == [False, True]
    assert (tmp_path / "out_1.h5").read_bytes() == (tmp_path / "out_2.h5").read_bytes()


@pytest.mark.skipif(os.name != "posix", reason="other systems have no such locks")
def test_a_process_that_dies_while_it_pours_leaves_its_turn_to_the_next(process, tmp_path):
    first, second = process(1, 600.0), process(2, 0.0)
    ask(first)
    wait_for(tmp_path / "started")
    ask(second)
    first.send_signal(signal.SIGKILL)
    assert answer(second)
    assert (tmp_path / "out_2.h5").is_file()
