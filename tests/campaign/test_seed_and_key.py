"""What names a run and what seeds it."""

from lithobrake.campaign import run_key, run_seed


def test_the_order_of_the_inputs_does_not_matter() -> None:
    assert run_key({"a": 1.0, "b": 2.0}, 1, 0, {}) == run_key({"b": 2.0, "a": 1.0}, 1, 0, {})


def test_whatever_determines_a_run_changes_its_key() -> None:
    keys = {
        run_key({"a": 1.0}, 1, 0, {}), run_key({"a": 1.0 + 2**-52}, 1, 0, {}), run_key({"b": 1.0}, 1, 0, {}),
        run_key({"a": 1.0}, 2, 0, {}), run_key({"a": 1.0}, 1, 1, {}), run_key({"a": 1.0}, 1, 0, {"version": "2"}),
    }  # fmt: skip
    assert len(keys) == 6


def test_the_seed_does_not_know_the_version() -> None:
    assert run_seed({"a": 1.0}, 1, 0) == run_seed({"a": 1.0}, 1, 0)
    assert len({run_seed({"a": 1.0}, 1, 0), run_seed({"a": 1.0}, 1, 1), run_seed({"a": 1.0}, 2, 0)}) == 3
    assert 0 <= run_seed({"a": 1.0}, 1, 0) < 2**53


def test_keys_and_seeds_are_the_same_on_every_machine() -> None:
    # Fixed once: a ledger of last year must still be found.
    assert run_key({"a": 0.1}, 1, 0, {"x": [1]})[:16] == "cf9d2fb58b6476f1"
    assert run_seed({"a": 0.1}, 1, 0) == 5473392904389371
