"""A sole that leans on its edge is told from one that is flat near it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from made_recording import FOOT, made_recording
from made_recording import PERIOD as STEP
from made_recording import swayed as two_sines
from plantar.feet.exclusion.edge_rolling import NEAR, _bush_model, leaning, without_edge_rolling
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import filtered_recording
from plantar.feet.settings import FeetSettings
from plantar.results.walk_rows import SwingZero
from plantar.robot.model import RobotModel
from plantar.twin.robots import hrp2
from twin_samples import walked

PERIOD = 0.005
TIME = np.arange(2000) * PERIOD
STIFFNESS, LOAD, EDGE = 400.0, 500.0, 0.1
STANDS = np.ones(TIME.size, dtype=bool)


def swayed(
    reach: float | np.ndarray, creep: float = 0.0, zero: float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Excess (N, 2), depth (N,) and true lean (N,) of a sway of `reach` [rad] at 0.3 Hz over a sole that may tip.

    The torque stops at LOAD·EDGE while the foot turns on; `creep` [rad] lets the excess wander with the sway, as
    hysteresis does; `zero` [N·m] shifts the measured torque.
    """
    random = np.random.default_rng(0)
    angle = reach * np.sin(2 * np.pi * 0.3 * TIME)
    torque = np.minimum(STIFFNESS * angle, LOAD * EDGE)
    lean = angle - torque / STIFFNESS
    wander = creep * np.cos(2 * np.pi * 0.3 * TIME)
    excess = np.column_stack([lean + wander, np.zeros(TIME.size)]) + random.normal(0, 1e-4, (TIME.size, 2))
    depth = EDGE - (torque + zero) / LOAD + random.normal(0, 2e-4, TIME.size)
    return excess, depth, lean


def found(excess: np.ndarray, depth: np.ndarray, margin: float = 0.005) -> np.ndarray:
    return leaning(excess, depth, np.full(TIME.size, LOAD), depth < margin, STANDS, PERIOD)


@pytest.mark.parametrize("zero", [0.0, 1.0, -1.0])
@pytest.mark.parametrize(("reach", "creep"), [(0.16, 0.0), (0.16, 0.01), (0.14, 0.01)])
def test_a_lean_is_found_in_its_samples(reach: float, creep: float, zero: float) -> None:
    """Whatever the torque's zero, and with the excess wandering by thrice the lean that counts."""
    excess, depth, lean = swayed(reach, creep, zero)
    tips = lean > 0.002
    said = found(excess, depth, 0.008)
    assert np.mean(tips[said]) > 0.9, "precision"
    assert np.mean(said[tips]) > 0.9, "recall"


def test_a_large_lean_shows_where_the_edge_is_and_a_small_one_is_then_found() -> None:
    """Alone the small one drowns in an excess that wanders as far."""
    reach = np.where(TIME < 5, 0.16, 0.132)
    excess, depth, lean = swayed(reach, creep=0.012)
    small = (TIME > 5) & (lean > 0.004)
    assert 0 < lean[small].max() < 0.008
    assert np.mean(found(excess, depth)[small]) > 0.9
    depth[TIME < 5] = EDGE
    assert np.mean(found(excess, depth)[small]) < 0.5


@pytest.mark.parametrize("creep", [0.0, 0.01])
def test_a_flat_sole_near_its_edge_serves(creep: float) -> None:
    """The centre of pressure comes within 2 mm of the edge and goes back."""
    excess, depth, lean = swayed(0.98 * LOAD * EDGE / STIFFNESS, creep)
    assert lean.max() < 1e-12
    assert (depth < 0.005).sum() > 100
    assert not found(excess, depth).any()


def test_what_is_usual_is_told_by_a_sole_that_is_flat() -> None:
    """A sole that leans for seven tenths of each second, by 8 mrad: how its excess changes then is no noise."""
    random = np.random.default_rng(0)
    phase = np.mod(TIME, 1.0) / 0.7
    lean = 0.008 * np.where(phase < 1, np.sin(np.pi * phase) ** 2, 0.0)
    excess = np.column_stack([lean, 0 * lean]) + random.normal(0, 1e-4, (TIME.size, 2))
    depth = np.where(phase < 1, 0.0, 0.03) + random.normal(0, 2e-4, TIME.size)
    said = found(excess, depth)
    assert said[lean > 0.005].mean() > 0.9
    assert not said[phase > 1.05].any()


def test_without_a_flat_stretch_nothing_is_trusted() -> None:
    excess, depth, _ = swayed(0.16)
    said = leaning(excess, depth, np.full(TIME.size, LOAD), depth < 0.005, depth < 0.005, PERIOD)
    assert said[depth < 0.005].all()


@pytest.mark.parametrize("always", [False, True])
def test_a_foot_zeroed_under_load_has_no_centre_of_pressure_to_be_judged_by(
    robot: RobotModel, always: bool
) -> None:
    left = replace(robot.feet["left"], contact="always" if always else "auto")
    robot = replace(robot, feet={**robot.feet, "left": left})
    recording = filtered_recording(prepare(robot, record(sway(duration=12.0)), "fit"), 5.0)
    state = recording.bushes["left"]
    outside = (
        state.cop + 2 * np.ptp(left.sole.polygon, axis=0) * (np.abs(recording.time - 6.0) < 1.0)[:, None]
    )
    moved = replace(state, cop=outside)
    recording = replace(recording, bushes={**recording.bushes, "left": moved})
    (rest,) = without_edge_rolling(robot, [recording], FeetSettings())
    assert (rest.used("left").sum() < recording.used("left").sum()) == (not always)
    assert rest.used("right").sum() == recording.used("right").sum()


@pytest.mark.parametrize(
    ("depth", "read", "used"), [(0.03, False, True), (0.01, False, False), (0.01, True, True)]
)
def test_an_angles_zero_moves_edges_by_a_usual_zero_of_the_torque_at_most(
    robot: RobotModel, depth: float, read: bool, used: bool
) -> None:
    """A turned IMU gives the torque an offset of tens of N.m, a sole's half length of the centre of pressure: a sensor
    is off by 6 mm of the weight, 12 mm on two feet; one whose zero was read in the air is not."""
    recording = filtered_recording(prepare(robot, record(sway(duration=12.0)), "fit"), 5.0)
    near = np.abs(recording.time - 6.0) < 0.5
    front = robot.feet["left"].sole.polygon[:, 0].max()
    cop = np.column_stack([front - np.where(near, 0.002, depth), 0.0 * recording.time])
    turned = replace(recording.bushes["left"], cop=cop, deflection=recording.bushes["left"].deflection + 0.1)
    raw = replace(recording.raw["left"], deflection=recording.raw["left"].deflection + 0.1)
    recording = replace(
        recording,
        bushes={**recording.bushes, "left": turned},
        raw={**recording.raw, "left": raw},
        zeros=(SwingZero("sway", "left", 1.0, *[(0.0, 0.0, 0.0)] * 4),) if read else (),
    )
    (rest,) = without_edge_rolling(robot, [recording], FeetSettings())
    assert (rest.used("left")[~near].mean() > 0.9) == used


@pytest.mark.parametrize(("width", "used"), [(0.042, True), (0.12, True), (0.026, False)])
def test_the_middle_of_a_narrow_sole_is_not_its_edge(robot: RobotModel, width: float, used: bool) -> None:
    """6 mm aside of it, of a robot whose angle has a zero: an edge moved by 12 mm would be met at 15 of 21 mm."""
    narrow = {}
    for name, foot in robot.feet.items():
        polygon = foot.sole.polygon * [1.0, width / np.ptp(foot.sole.polygon[:, 1])]
        narrow[name] = replace(foot, sole=replace(foot.sole, polygon=polygon))
    robot = replace(robot, feet=narrow)
    recording = filtered_recording(prepare(robot, record(sway(duration=12.0)), "fit"), 5.0)
    near = np.abs(recording.time - 6.0) < 0.5
    middle = robot.feet["left"].sole.polygon[:, 1].mean()
    side = np.where(near, width / 2 - 0.002, 0.006)
    cop = np.column_stack([0.0 * recording.time, middle + side])
    state, raw = (each["left"] for each in (recording.bushes, recording.raw))
    turned = replace(state, cop=cop, deflection=state.deflection + 0.1)
    recording = replace(
        recording,
        bushes={**recording.bushes, "left": turned},
        raw={**recording.raw, "left": replace(raw, deflection=raw.deflection + 0.1)},
    )
    (rest,) = without_edge_rolling(robot, [recording], FeetSettings())
    assert (rest.used("left")[~near].mean() > 0.9) == used


@pytest.mark.parametrize(("inside", "used"), [(0.001, False), (0.004, False), (0.02, True)])
def test_a_foot_that_steps_is_left_out_near_its_edge(inside: float, used: bool) -> None:
    """In the middle of one stance, flat as it is: a lean of each step is too small to be told."""
    twin = hrp2.robot()
    recording = filtered_recording(prepare(twin, checked(twin, walked()), "fit"), 5.0)
    stances = recording.stances["left"]
    assert stances is not None
    first, *_, last = np.flatnonzero(stances.number == 2)
    middle = np.abs(recording.time - recording.time[(first + last) // 2]) < 0.08
    side = twin.feet["left"].sole.polygon[:, 1].max()
    raw, seen = ({**each} for each in (recording.raw, recording.bushes))
    for states in (raw, seen):
        cop = states["left"].cop.copy()
        cop[middle, 1] = side - inside
        states["left"] = replace(states["left"], cop=cop)
    tipped = replace(recording, raw=raw, bushes=seen)
    (rest,), (before,) = (without_edge_rolling(twin, [one], FeetSettings()) for one in (tipped, recording))
    assert (rest.used("left") & middle).any() == used
    # Nor does it matter that others stand, and show how stiff the bush is.
    standing = replace(recording, stances=dict.fromkeys(recording.stances))
    beside, _ = without_edge_rolling(twin, [tipped, standing], FeetSettings())
    assert (beside.used("left") & middle).any() == used
    elsewhere = (stances.number >= 0) & (stances.number != 2)
    assert (rest.used("left") == before.used("left"))[elsewhere].all()


@pytest.mark.parametrize(("stiffness", "known"), [(400.0, True), (-400.0, False)])
def test_a_bush_is_known_from_what_is_clear_of_edges(stiffness: float, known: bool) -> None:
    """Its torque is another one up to NEAR from an edge; two recordings' zeros, of 3 and 4 N.m, are usually 3.5."""
    place = np.arange(3000)
    edge = np.abs(place - 1500) < 100
    off = np.abs(place - 1500) < 100 + round(NEAR / STEP) - 1
    made = []
    for seed, zero in enumerate((3.0, -4.0)):
        angle = two_sines(seed=seed)
        torque = stiffness * angle + 12.0 * np.gradient(angle, STEP) + zero
        made.append(made_recording(f"sway_{seed}", angle, np.where(off, 0.0, torque)))
    found = _bush_model(made, FOOT, [edge, edge])
    assert (found is not None) == known
    if found is not None:
        assert found[0] == pytest.approx([400.0, 400.0])
        assert found[1] == pytest.approx([12.0, 12.0])
        assert found[2] == pytest.approx(np.sqrt(12.5))
    assert _bush_model(made, FOOT, [place >= 0, place >= 0]) is None
