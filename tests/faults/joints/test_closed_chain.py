"""Encoders that stand still while both legs' closed chain says that their joint moves."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from biped import record, sway
from feet_trials import noisy
from plantar.errors import DataError
from plantar.faults.joints import closed_chain
from plantar.faults.joints.closed_chain import _exchanged_legs, _own_angle, _Stand, check_closed_chain
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.twin import PAPER, PRESETS
from plantar.twin.play import rolled
from plantar.twin.recording import record as record_twin
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics
from twin_samples import plan, short, walked


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return noisy(record(sway()), 1)


def stuck(log: MotionLog, joint: str, start: int = 0, stop: int = 2001) -> MotionLog:
    """The log in which one encoder repeats its value, so that the velocity made from it is zero."""
    position, velocity = (log.column(f"joint.{joint}.{kind}").copy() for kind in ("position", "velocity"))
    position[start:stop], velocity[start:stop] = position[start], 0.0
    return log.with_columns({f"joint.{joint}.position": position, f"joint.{joint}.velocity": velocity})


@pytest.mark.parametrize("joint", ["right_ankle_pitch", "left_ankle_roll"])
@pytest.mark.parametrize(("start", "stop"), [(0, 2001), (900, 2001), (300, 800)])
def test_a_stuck_encoder_is_found_and_named(
    robot: RobotModel, log: MotionLog, joint: str, start: int, stop: int
) -> None:
    spoilt = stuck(log, joint, start, stop)
    (finding,) = check_closed_chain(robot, spoilt)
    assert finding.fatal
    assert f"column 'joint.{joint}.position', t = {log.time[start + 1]:g}" in finding.text
    moved = float(np.ptp(log.column(f"joint.{joint}.position")[start:stop]))
    said = float(finding.text.split("moves it by ")[1].split(";")[0])
    assert said == pytest.approx(moved, rel=0.2)
    with pytest.raises(DataError, match="the encoder is dead"):
        identify_feet(robot, [spoilt])


def test_joints_that_stand_are_not_dead(robot: RobotModel) -> None:
    """Ankles that hold their angle, the one under a foot in the air, and encoders that read in coarse steps."""

    def still(t: np.ndarray) -> np.ndarray:
        return 0.0 * t + 0.02

    moving = sway()
    stands = sway(ankles={**moving.ankles, "right": (still, still)})
    assert not list(check_closed_chain(robot, record(stands)))
    lifted = sway(ankles=stands.ankles, lifts=(("right", -1.0, 30.0),))
    assert not list(check_closed_chain(robot, record(lifted)))
    log, name = record(moving), "joint.left_ankle_pitch.position"
    assert not list(
        check_closed_chain(robot, log.with_columns({name: np.round(log.column(name) / 0.05) * 0.05}))
    )


@pytest.mark.parametrize(("apart", "told"), [(0.0101, True), (0.0099, False)])
@pytest.mark.parametrize("mirrored", [1.0, -1.0])
def test_legs_that_move_alike_are_not_told_exchanged(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch, apart: float, told: bool, mirrored: float
) -> None:
    """Within a hundredth of a radian they read next to the same: their soles then seem to move by anything's doing."""
    log = record(sway(duration=12.0))
    wave = np.sin(log.time)
    still = {name: 1e-4 * wave for name in log.columns if name.startswith("joint.")}
    moving = {
        "joint.left_ankle_pitch.position": 0.05 * wave,
        "joint.right_ankle_pitch.position": mirrored * (0.05 + apart / 2) * wave,
    }
    reads = iter([1.0, 0.1])  # as read, and exchanged
    monkeypatch.setattr(
        "plantar.faults.joints.closed_chain._soles",
        lambda states: next(reads) * np.sin(np.arange(len(states["left"].force_z)))[:, None],
    )
    said = [one.text for one in check_closed_chain(robot, log.with_columns(still | moving)) if one.fatal]
    assert (
        said
        == [
            "columns 'joint.left_leg_x.position', 'joint.right_leg_x.position', ...: the legs look exchanged: so the "
            "soles on the floor move far less (valid: each leg's joints under their own names)"
        ]
        * told
    )


def test_exchanged_legs_are_refused() -> None:
    """The twin leans into a corner, so that its legs move each in its own way."""
    twin, sensors = hrp2.robot(), PRESETS["sensors"]
    rollout = rolled(short(plan("Tilt3"), 10.0, 14.0), twin, Physics())
    log = record_twin(rollout, twin, sensors.physics(PAPER), sensors, 0).log
    assert not list(check_closed_chain(twin, log))
    legs = {"RLEG": "LLEG", "LLEG": "RLEG"}
    exchanged = {
        name: log.column(name.replace(leg, legs[leg])) for name in log.columns for leg in legs if leg in name
    }
    (found,) = check_closed_chain(twin, log.with_columns(exchanged))
    assert (found.code, found.fatal) == ("joint_names", True)
    assert "legs look exchanged" in found.text


@pytest.mark.parametrize("joints", [{"left": (), "right": ()}, {"left": ("knee",), "right": ()}])
def test_legs_that_differ_or_have_no_joints_cannot_be_exchanged(
    joints: dict[str, tuple[str, ...]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(closed_chain, "legs", lambda _: joints)
    robot = SimpleNamespace(joint_names=("knee",))
    stand = SimpleNamespace(robot=robot, positions=np.zeros((5, 1)))
    assert list(_exchanged_legs(stand, np.zeros(5, dtype=np.intp))) == []  # type: ignore[arg-type]


def test_a_sole_that_slides_may_be_a_stuck_encoder(robot: RobotModel) -> None:
    """Its path may look like the angle of a joint that stands; the torque does not follow, so nothing is refused."""

    def still(t: np.ndarray) -> np.ndarray:
        return 0.0 * t

    log = record(sway(ankles={**sway().ankles, "right": (still, still)}))
    slide = log.column("joint.right_leg_x.position") + 0.01 * np.sin(1.1 * log.time)
    findings = list(check_closed_chain(robot, log.with_columns({"joint.right_leg_x.position": slide})))
    assert {(one.code, one.fatal) for one in findings} == {("stuck_channel", False)}
    assert all(
        one.text.endswith("; is the encoder stuck, or did a sole slide? (valid: leave such cells empty)")
        for one in findings
    )


@pytest.mark.parametrize("kind", ["joint", "wrench"])
def test_a_robot_that_stands_on_the_foot_in_the_air_has_its_sides_exchanged(kind: str) -> None:
    """In a walk's short double supports soles say little; a leg of the other name swings below the one that stands."""
    twin, walk = hrp2.robot(), walked()
    assert list(check_closed_chain(twin, walk)) == []
    if kind == "joint":
        sides = {"RLEG_": "LLEG_", "LLEG_": "RLEG_"}
    else:
        sides = {"right_foot": "left_foot", "left_foot": "right_foot"}
    exchanged = {
        name: walk.column(name.replace(mine, other))
        for name in walk.columns
        for mine, other in sides.items()
        if name.startswith(f"{kind}.{mine}")
    }
    (found,) = check_closed_chain(twin, walk.with_columns(exchanged))
    assert (found.code, found.fatal) == ("joint_names", True)
    assert found.text.partition(" cm ")[2] == (
        "higher than the one in the air; the legs' joints look exchanged, or the force sensors "
        "(valid: each leg's joints and sensor under their own names)"
    )
    assert found.text.startswith("columns 'joint.*.position': the foot that carries the robot alone is ")
    # Neither a second or two on one foot says so, nor a leg that stands at its neutral posture for lack of a column.
    log = walk.with_columns(exchanged)
    assert list(check_closed_chain(twin, log.select(log.time < log.time[0] + 5.2))) == []
    kept = {name: log.column(name) for name in log.columns if name != "joint.RLEG_JOINT0.position"}
    assert len(kept) < len(log.columns)
    assert list(check_closed_chain(twin, replace(log, columns=kept))) == []


def test_a_joint_that_moves_no_sole_closes_no_chain() -> None:
    """Of an arm the legs' closed chain says nothing, whatever the soles do."""
    twin, walk = hrp2.robot(), walked()
    rows = slice(0, 200)
    orientation = walk.orientation(twin.required_imu.name)
    assert orientation is not None
    wrenches = {name: walk.wrench(foot.wrench.name)[rows] for name, foot in twin.feet.items()}
    stand = _Stand(twin, orientation[rows], walk.positions(twin)[rows], wrenches)
    assert _own_angle(stand, "RARM_JOINT0", "right", {}) == (0.0, False)


def test_what_rounding_of_the_other_encoders_makes_of_a_joint_is_no_motion_of_it() -> None:
    """A hip's step of 12 bits moves a sole by a millimetre, which an ankle close above it would need many steps for."""
    twin, step = hrp2.robot(), 2 * np.pi / 2**12
    walk = walked().select(walked().time < 2.0)
    positions = np.tile(walk.positions(twin)[:1], (len(walk), 1))
    positions[::2, twin.joint_names.index("LLEG_JOINT2")] += step
    orientation = walk.orientation(twin.required_imu.name)
    assert orientation is not None
    wrenches = {name: walk.wrench(foot.wrench.name) for name, foot in twin.feet.items()}
    stand = _Stand(twin, np.tile(orientation[:1], (len(walk), 1)), positions, wrenches)
    assert _own_angle(stand, "LLEG_JOINT4", "left", {})[0] > 4 * step
    assert _own_angle(stand, "LLEG_JOINT4", "left", {"LLEG_JOINT2": step / 3})[0] > 4 * step
    assert _own_angle(stand, "LLEG_JOINT4", "left", {"LLEG_JOINT2": step}) == (0.0, False)
