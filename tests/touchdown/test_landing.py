"""Landings on a small bed: outcomes, outputs, frames, refusals."""

import dataclasses
import math

import h5py
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, Material, Sphere, read_hull
from lithobrake.touchdown import OUTPUTS, ContactModel, Lander, land, simulation
from lithobrake.touchdown.landing import outgoing
from lithobrake.touchdown.simulation import CALM_SPEED, released_speed
from lithobrake.vocabulary.field_errors import FieldError

from .landings import landing as on_rock

BOUNCY = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.9, friction=0.3, density=2500.0)
DEAD = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.05, friction=0.9, density=2500.0)


def landing(**changes):
    return on_rock(**{"grain": BOUNCY, **changes})


def ball(material=BOUNCY, mass=0.3):
    return Lander(shape=Sphere(0.06), mass=mass, material=material)


def test_bouncy_ball_rebounds_and_tells_of_it(bed):
    outcome = land(bed, ball(), landing(), frame_count=4)
    assert (outcome.status, set(outcome.outputs)) == ("clear", set(OUTPUTS))
    out = outcome.outputs
    velocity = np.array([out["velocity_out_x"], out["velocity_out_y"], out["velocity_out_z"]])
    assert out["speed_out"] == pytest.approx(np.linalg.norm(velocity), rel=1e-12)
    assert math.sin(out["elevation_out"]) == pytest.approx(velocity[2] / out["speed_out"], rel=1e-9)
    assert 0.0 < out["speed_out"] < 0.3
    assert out["velocity_out_z"] > 0.0
    spin_energy = 0.5 * 0.4 * 0.3 * 0.06**2 * out["spin_out"] ** 2
    kept = 0.5 * 0.3 * out["speed_out"] ** 2 + spin_energy
    assert out["energy_lost"] == pytest.approx(0.5 * 0.3 * 0.09 - kept, rel=1e-9)
    assert out["contact_duration"] > 0.0
    assert out["penetration"] > 0.0
    assert out["peak_acceleration"] > 0.3 / out["contact_duration"]
    assert 4 <= len(outcome.frames["time"]) <= 8
    assert outcome.frames["position"].shape[1:] == (25, 3)


@pytest.mark.parametrize("change", [{"yield_strength": 2e4}, {"restitution_speed": 0.01}])
def test_what_yields_or_is_viscous_gives_back_less_at_speed(bed, change):
    soft = dataclasses.replace(BOUNCY, **change)
    hard, found = (land(bed, ball(one), landing(grain=one)).outputs for one in (BOUNCY, soft))
    assert found["speed_out"] < 0.95 * hard["speed_out"]


def test_turning_ground_bends_the_way_of_a_lander_that_hops(bed):
    """Against ground that stands still, by the Coriolis acceleration over the time since the release at most."""
    ways = []
    for rotation in ((0.0, 0.0, 0.0), (0.0, 0.0, 1e-3)):
        one = landing(rotation=rotation, hop_height=0.2, time_limit=400.0)
        outcome = land(bed, ball(), one)
        ways.append((outcome.status, outcome.outputs))
    (still, before), (turning, after) = ways
    assert still == turning == "clear"
    lasts = after["duration"]
    assert 0.0 < abs(after["velocity_out_y"] - before["velocity_out_y"]) < 2.0 * 2e-3 * 0.3 * max(lasts, 1.0)


def test_a_rotation_that_is_no_number_is_refused_by_its_name():
    with pytest.raises(FieldError, match=r"Landing\.rotation"):
        landing(rotation=(0.0, math.nan, 0.0))


def test_heavy_dead_box_is_captured(bed):
    lander = Lander(shape=Box((0.1, 0.1, 0.1)), mass=3.0, material=DEAD)
    outcome = land(bed, lander, landing(grain=DEAD, speed=0.02, incidence=0.0, time_limit=200.0))
    assert outcome.status == "captured"
    assert math.isnan(outcome.outputs["speed_out"])
    left = 0.5 * 3.0 * 0.02**2 - outcome.outputs["energy_lost"]
    gravity = -landing().gravity[2]
    assert left < max(1e-4 * 0.5 * 3.0 * 0.02**2, 3.0 * gravity * 0.5 * 0.1)
    assert math.isfinite(outcome.outputs["penetration"])


def test_flat_throw_leaves_sideways(bed):
    outcome = land(bed, ball(), landing(incidence=1.5, speed=1.0, place=(-0.1, 0.0), azimuth=0.0))
    assert outcome.status in ("left_sideways", "clear")
    outside = land(bed, ball(), landing(incidence=1.55, speed=1.0, place=(0.15, 0.0), azimuth=0.0))
    assert outside.status == "left_sideways"


def test_time_limit_is_an_outcome(bed):
    assert land(bed, ball(), landing(time_limit=1e-3)).status == "time_limit"


def test_a_landing_tells_how_far_it_is(bed):
    told = {}
    # With steps of their own contacts take on the soil at once.
    together = ContactModel(steps_per_contact=25.0, stepping="global")
    land(bed, ball(), landing(contact=together), progress=lambda share, what: told.setdefault(what, []).append(share))
    assert list(told) == ["bed taking on the soil of the landing", "landing, up to its time limit"]
    for shares in told.values():
        assert shares == sorted(shares)
        assert len(shares) > 5
        assert 0.0 <= shares[0] < shares[-1] <= 1.0


def test_same_landing_same_bits(bed):
    first, second = (land(bed, ball(), landing(speed=0.1)) for _ in range(2))
    assert first.outputs == second.outputs or str(first.outputs) == str(second.outputs)
    assert first.status == second.status


@pytest.mark.parametrize("gravity", [(0.0, 0.0, 0.0), (0.0, 0.0, 1e-5), (1e-4, 0.0, -4e-4)])
def test_any_constant_acceleration_is_accepted(bed, gravity):
    assert land(bed, ball(), landing(gravity=gravity)).status == "clear"


def test_outgoing_velocity_is_told_along_the_incoming_one():
    still = np.array([1.0, 0.0, 0.0, 0.0])
    out = outgoing(np.array([0.0, 2.0, 1.0]), np.array([3.0, 0.0, 4.0]), still, math.pi / 2, over_rim=False)
    assert (out["velocity_out_x"], out["velocity_out_y"]) == (pytest.approx(2.0), pytest.approx(0.0, abs=1e-12))
    assert (out["spin_out"], out["azimuth_out"]) == (5.0, pytest.approx(0.0, abs=1e-12))
    assert [out[f"spin_out_{axis}"] for axis in "xyz"] == pytest.approx([0.0, -3.0, 4.0], abs=1e-12)
    # Seen from a frame turned to the left, a lander that has not turned is turned to the right.
    half = math.sqrt(0.5)
    assert [out[f"orientation_out_{part}"] for part in "wxyz"] == pytest.approx([half, 0.0, 0.0, -half])
    assert out["over_rim"] == 0.0


@pytest.mark.parametrize("azimuth", [0.0, 0.7])
def test_a_frictionless_ball_leaves_with_the_spin_that_it_came_with_and_turned_by_it(ground, azimuth):
    slick = dataclasses.replace(BOUNCY, friction=0.0)
    spin, start = np.array([1.0, -2.0, 0.5]), np.array([0.9, 0.3, 0.2, 0.1])
    outcome = land(ground, ball(slick), landing(spin=tuple(spin), orientation=tuple(start), azimuth=azimuth))
    out, rate = outcome.outputs, float(np.linalg.norm(spin))
    local = Rotation.from_euler("z", -azimuth)
    assert outcome.status == "clear"
    assert [out[f"spin_out_{axis}"] for axis in "xyz"] == pytest.approx(local.apply(spin), rel=1e-9)
    assert out["spin_out"] == pytest.approx(rate, rel=1e-9)
    after = Rotation.from_rotvec(spin * outcome.simulated_time)
    expected = local * after * Rotation.from_quat(start, scalar_first=True)
    found = Rotation.from_quat([out[f"orientation_out_{part}"] for part in "wxyz"], scalar_first=True)
    # A step turns a body without a couple exactly, so only rounding of some thousand steps is left.
    assert (found * expected.inv()).magnitude() < 1e-9
    assert out["orientation_out_w"] >= 0.0


def test_recorded_landing_is_written(bed, tmp_path):
    land(bed, ball(), landing(), frame_count=4).save_frames(tmp_path / "landing.h5", bed, ball(), landing())
    with h5py.File(tmp_path / "landing.h5") as file:
        assert (file.attrs["status"], len(file["vertex_start"])) == ("clear", 26)
        assert file["frames/position"].shape[1:] == (25, 3)
        force = file["frames/force"][:]
    # A lander above its bed and one that has left it feel no grain; between, the sum that slowed it down.
    assert force.shape[1:] == (25,)
    assert force[0, -1] == force[-1, -1] == 0.0


def test_the_pictures_change_nothing_of_a_landing(bed):
    plain, seen = (land(bed, ball(), landing(), frame_count=count) for count in (0, 50))
    assert plain.outputs == seen.outputs
    assert seen.frames["force"][:, -1].max() > 0.0
    assert seen.frames["force"][:, -1].max() <= seen.outputs["peak_acceleration"] * ball().mass * (1 + 1e-12)


def test_every_data_set_of_a_bed_and_of_a_landing_says_what_it_holds(bed, tmp_path):
    land(bed, ball(), landing(), frame_count=1).save_frames(tmp_path / "landing.h5", bed, ball(), landing())
    bed.save(tmp_path / "bed.h5")
    for name, count in (("landing.h5", 11), ("bed.h5", 14)):
        with h5py.File(tmp_path / name) as file:
            found = {}
            file.visititems(lambda key, entry, found=found: found.update({key: dict(entry.attrs)}))
        sets = {key: attributes for key, attributes in found.items() if key not in ("frames", "history")}
        assert len(sets) == count
        assert all(attributes["long_name"] and "units" in attributes for attributes in sets.values())
        assert (sets["frames/time"]["units"], sets["frames/position"]["units"]) == ("s", "m")
        assert sets["position"]["frame"].startswith("of the bed")


@pytest.mark.parametrize(
    ("name", "value"), [("speed", 0.0), ("incidence", 1.6), ("time_limit", 0.0), ("azimuth", math.nan)]
)
def test_impossible_landings_are_refused(name, value):
    with pytest.raises(ValueError, match=f"Landing.{name}"):
        landing(**{name: value})


def test_place_outside_the_box_is_refused(bed):
    with pytest.raises(ValueError, match="place"):
        land(bed, ball(), landing(place=(1.0, 0.0)))


CUBE = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1))
FACES = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"


def test_meshes_of_landers_are_read_if_closed(tmp_path):
    (tmp_path / "cube.obj").write_text(CUBE + FACES)
    assert read_hull(tmp_path / "cube.obj").volume == pytest.approx(1.0)
    (tmp_path / "open.obj").write_text(CUBE + FACES[:-10])
    with pytest.raises(ValueError, match="not closed"):
        read_hull(tmp_path / "open.obj")
    (tmp_path / "empty.obj").write_text(CUBE)
    with pytest.raises(ValueError, match="0 facets cannot enclose a volume"):
        read_hull(tmp_path / "empty.obj")
    (tmp_path / "beyond.obj").write_text(CUBE + FACES.replace("8", "9"))
    with pytest.raises(ValueError, match="there are 1 to 8"):
        read_hull(tmp_path / "beyond.obj")
    (tmp_path / "cube.ply").write_text("")
    with pytest.raises(ValueError, match="ending"):
        read_hull(tmp_path / "cube.ply")


def test_a_lander_mesh_has_a_unit_and_only_what_its_faces_use(tmp_path):
    (tmp_path / "cube.obj").write_text(CUBE + FACES)
    assert read_hull(tmp_path / "cube.obj", "cm").volume == pytest.approx(1e-6)
    (tmp_path / "stray.obj").write_text(CUBE + "v 9 9 9\n" + FACES)
    assert read_hull(tmp_path / "stray.obj").volume == pytest.approx(1.0)


def test_stl_is_read_as_text(tmp_path):
    assert read_hull_of_stl(tmp_path).volume == pytest.approx(1 / 6)


def read_hull_of_stl(folder):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    lines = ["solid lander"]
    for triangle in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*corners[k]) for k in triangle] + ["endloop", "endfacet"]
    (folder / "lander.stl").write_text("\n".join([*lines, "endsolid lander"]))
    return read_hull(folder / "lander.stl")


@pytest.mark.parametrize(("mass", "speed"), [(1e6, 0.3), (0.3, 1e5)])
def test_a_lander_that_goes_through_the_floor_is_a_failure_and_no_fate(bed, mass, speed):
    with pytest.raises(ValueError, match=r"went through the floor: .*raise grain\.young_modulus .*lower lander\.mass"):
        land(bed, ball(mass=mass), landing(speed=speed))


@pytest.mark.parametrize(
    ("moments", "said"), [((0.001, 0.001, 0.01), "sum of the other two"), ((1.0, 1.0, -1.0), "positive definite")]
)
def test_an_inertia_that_no_body_has_is_refused(moments, said):
    with pytest.raises(ValueError, match=rf"Lander\.inertia .*{said}"):
        Lander(shape=Sphere(0.06), mass=0.3, material=BOUNCY, inertia=np.diag(moments))
    # A flat plate has moments of which one is the sum of the others.
    assert Lander(shape=Sphere(0.06), mass=0.3, material=BOUNCY, inertia=np.diag([0.1, 0.2, 0.1 + 0.2])).mass == 0.3


def test_a_lander_needs_a_mass():
    with pytest.raises(ValueError, match=r"Lander\.mass is 0\.0 kg"):
        ball(mass=0.0)


def test_contacts_at_steps_of_their_own_tell_the_same_story(bed):
    local = ContactModel(steps_per_contact=30.0, stepping="local")
    found = [land(bed, ball(), landing(contact=local), frame_count=4) for _ in range(2)]
    one, again = (outcome.outputs for outcome in found)
    assert one == again
    together = land(bed, ball(), landing(contact=ContactModel(steps_per_contact=60.0, stepping="global"))).outputs
    assert found[0].status == "clear"
    # What the first blow decides agrees; what follows it is chance.
    assert one["peak_acceleration"] == pytest.approx(together["peak_acceleration"], rel=0.05)
    assert one["energy_lost"] == pytest.approx(together["energy_lost"], rel=0.05)
    assert 4 <= len(found[0].frames["time"]) <= 8
    assert (np.diff(found[0].frames["time"]) > 0.0).all()


def test_a_bed_takes_on_its_soil_at_once_where_that_frees_little(bed):
    soft, stiff = BOUNCY, dataclasses.replace(BOUNCY, young_modulus=1e8)
    speeds = [released_speed(bed, material) for material in (soft, stiff)]
    # Of overlaps that stay, a soil a hundred times as stiff holds a hundred times the energy.
    assert speeds[1] == pytest.approx(10.0 * speeds[0], rel=1e-6)
    for material, relaxed in ((soft, False), (stiff, True)):
        told = []
        # Beside the mean of both speeds it frees little, or much.
        speed = math.sqrt(speeds[0] * speeds[1]) / CALM_SPEED
        short = landing(grain=material, speed=speed, time_limit=1e-3)
        land(bed, ball(), short, progress=lambda share, what, told=told: told.append(what))
        assert ("bed taking on the soil of the landing" in told) == relaxed
    world = bed.world(stiff, bed.gravity, ContactModel())
    assert speeds[1] == pytest.approx(math.sqrt(2.0 * world.energy()["elastic"] / float(world.mass.sum())), rel=1e-6)


def test_a_much_softer_soil_frees_what_its_grains_lose_as_they_sink(bed):
    at_rest = dataclasses.replace(BOUNCY, young_modulus=bed.young_modulus, poisson_ratio=bed.poisson_ratio)
    soft = dataclasses.replace(at_rest, young_modulus=bed.young_modulus / 8.0)
    # One contact under a constant load F holds 2/5 F d, and sinks from d to 4 d: the load does 3 F d of work, of which
    # 8/5 F d - 1/20 F d stay elastic from where the soil is switched on.
    freed = (3.0 - (0.4 * 4.0 - 0.4 / 8.0)) / 0.4
    ratio = released_speed(bed, soft) / released_speed(bed, at_rest)
    assert ratio == pytest.approx(math.sqrt(freed), rel=1e-9)


def test_another_stepping_is_refused():
    with pytest.raises(ValueError, match=r"stepping is 'own'; allowed are"):
        ContactModel(stepping="own")


def test_held_grains_ask_for_local_steps():
    with pytest.raises(ValueError, match=r'held_speed is 0\.1; allowed with stepping "global" is 0'):
        ContactModel(stepping="global", held_speed=0.1)
    with pytest.raises(ValueError, match=r"held_speed is 1\.0; allowed is 0 <= value < 1"):
        ContactModel(stepping="local", held_speed=1.0)


@pytest.mark.parametrize("stepping", ["local", "global"])
def test_the_depth_does_not_depend_on_how_often_the_lander_is_looked_at(bed, stepping, monkeypatch):
    depths = []
    for way, checks in ((0.05, 5), (0.002, 50)):
        monkeypatch.setattr(simulation, "LOOK_WAY", way)
        monkeypatch.setattr(simulation, "CHECKS_PER_CONTACT", checks)
        contact = ContactModel(steps_per_contact=50.0, stepping=stepping)
        depths.append(land(bed, ball(), landing(contact=contact, time_limit=0.6)).outputs["penetration"])
    assert depths[0] > 0.0
    assert depths[0] == pytest.approx(depths[1], rel=0.01)
