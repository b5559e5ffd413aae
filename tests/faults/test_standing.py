"""Signs, mountings and stuck channels, found in a few seconds of a robot that obeys Newton: the twin's."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from plantar.faults import standing
from plantar.faults.log_faults import check_log
from plantar.faults.stance import Stance, stance_of
from plantar.faults.stance_changes import StanceChanges
from plantar.faults.standing import check_balance
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.twin import PAPER, PRESETS
from plantar.twin.play import rolled
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from twin_samples import SETTLED, planned_part, swayed, tilted, walked

SENSORS = PRESETS["sensors"]


@pytest.fixture(scope="module")
def sway() -> MotionLog:
    """The right foot alone, rolled by an operator."""
    return record(swayed(), hrp2.robot(), SENSORS.physics(PAPER), SENSORS, 0).log


@pytest.fixture(scope="module")
def tilt() -> MotionLog:
    """Both feet, nobody near."""
    return record(tilted(), hrp2.robot(), SENSORS.physics(PAPER), SENSORS, 0).log


def reversed_(log: MotionLog, *names: str) -> MotionLog:
    return log.with_columns({name: -log.column(name) for name in names})


def found(log: MotionLog) -> list[Finding]:
    return check_log(hrp2.robot(), log)


def test_a_robot_as_it_should_be_raises_no_alarm(sway: MotionLog, tilt: MotionLog) -> None:
    assert [finding for log in (sway, tilt) for finding in found(log) if finding.severity == "warning"] == []


def test_a_reversed_torque_is_named(sway: MotionLog) -> None:
    (finding,) = [one for one in found(reversed_(sway, "wrench.right_foot.torque.x")) if one.code == "sign"]
    assert "wrench.right_foot.torque.x" in finding.text
    assert not finding.fatal


def test_a_reversed_joint_is_named_and_refused_instead_of_swapped_feet(sway: MotionLog) -> None:
    robot = hrp2.robot()
    assert robot.imu is not None
    legs = robot.joints_between(robot.imu.placement, robot.feet["right"].bush)
    largest = max(legs, key=lambda name: abs(np.median(sway.column(f"joint.{name}.position"))))
    findings = found(reversed_(sway, f"joint.{largest}.position"))
    assert [one.code for one in findings if one.fatal] == ["sign"]
    assert any(f"joint.{largest}.position" in one.text for one in findings if one.fatal)
    assert "not the motors of a parallel linkage" in next(one.text for one in findings if one.fatal)


def test_a_hand_that_leans_on_the_robot_reverses_and_exchanges_no_joint(sway: MotionLog) -> None:
    """A steady moment of the robot's weight on 3 cm, in eight directions, as the loaded foot's torques read it."""
    moment = 0.03 * hrp2.robot().mass * 9.81
    for angle in np.arange(0, 2 * np.pi, np.pi / 4):
        leant = {
            f"wrench.right_foot.torque.{axis}": sway.column(f"wrench.right_foot.torque.{axis}")
            + moment * part
            for axis, part in (("x", np.cos(angle)), ("y", np.sin(angle)))
        }
        assert [one.text for one in found(sway.with_columns(leant)) if "joint." in one.text] == []


def test_exchanged_joints_of_a_leg_are_named(sway: MotionLog) -> None:
    joints = ["joint.RLEG_JOINT4.position", "joint.RLEG_JOINT5.position"]
    exchanged = dict(zip(joints, (sway.column(name) for name in reversed(joints)), strict=True))
    (finding,) = [one for one in found(sway.with_columns(exchanged)) if one.fatal]
    assert finding.code == "joint_names"
    assert "'joint.RLEG_JOINT4.position' and 'joint.RLEG_JOINT5.position': exchanged" in finding.text


def test_one_ankle_in_degrees_is_named(sway: MotionLog) -> None:
    ankle = "joint.RLEG_JOINT4.position"
    (finding,) = check_balance(hrp2.robot(), sway.with_columns({ankle: np.degrees(sway.column(ankle))}))
    assert (finding.code, finding.fatal) == ("degrees", True)
    assert f"column '{ankle}': read as degrees, the wrenches balance" in finding.text


def test_an_ankle_in_degrees_beside_one_at_zero_may_be_exchanged(
    sway: MotionLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Degrees of a joint that hardly bends are as good as zeros: both are told."""
    robot = hrp2.robot()
    stance = stance_of(robot, sway)
    assert stance is not None
    bent, still = (robot.joint_names.index(f"RLEG_JOINT{joint}") for joint in (4, 5))
    positions = np.ones_like(stance.positions)
    positions[:, still] = 0.0
    monkeypatch.setattr(
        Stance, "sides", lambda one: Mock(misfit=np.max(one.positions[:, bent]) / 10, lean=0.0)
    )
    changes = StanceChanges(replace(stance, positions=positions))
    assert changes.misread_joints(0.1) == {
        "read as degrees": "column 'joint.RLEG_JOINT4.position'",
        "exchanged": "columns 'joint.RLEG_JOINT4.position' and 'joint.RLEG_JOINT5.position'",
    }


def test_a_joint_that_is_not_recorded_is_named_before_what_it_spoils(sway: MotionLog) -> None:
    kept = {name: sway.column(name) for name in sway.columns if "RLEG_JOINT3" not in name}
    first = next(one for one in found(MotionLog("lame", sway.time, kept)) if one.fatal)
    assert first.code == "joint_names"
    assert first.text == (
        "columns 'joint.*.position': RLEG_JOINT3 not recorded, and with them at 0 the feet's wrenches do not balance "
        "gravity (valid: a position of every joint between IMU and feet)"
    )


def test_a_few_absurd_samples_reverse_nothing(tilt: MotionLog) -> None:
    torque = tilt.column("wrench.left_foot.torque.y").copy()
    torque[:3] = 1e5
    assert not any(
        one.code == "sign" for one in found(tilt.with_columns({"wrench.left_foot.torque.y": torque}))
    )


def test_torques_in_newton_millimetres_are_refused(sway: MotionLog, tilt: MotionLog) -> None:
    for log in (sway, tilt):
        torques = {name: 1000 * values for name, values in log.columns.items() if ".torque." in name}
        (finding,) = check_balance(hrp2.robot(), log.with_columns(torques))
        assert (finding.code, finding.fatal) == ("torque_unit", True)


def with_feet_exchanged(log: MotionLog) -> MotionLog:
    sides = {"right_foot": "left_foot", "left_foot": "right_foot"}
    return log.with_columns(
        {
            name: log.column(name.replace(side, sides[side]))
            for name in log.columns
            for side in sides
            if name.startswith(f"wrench.{side}.")
        }
    )


def test_wrenches_of_exchanged_feet_are_refused(sway: MotionLog) -> None:
    """Told where one foot carries more; two that carry the same are alike either way."""
    assert list(check_balance(hrp2.robot(), sway)) == []
    (finding,) = check_balance(hrp2.robot(), with_feet_exchanged(sway))
    assert (finding.code, finding.fatal) == ("swapped_feet", True)


def test_exchanged_feet_are_refused_in_a_sway_of_half_a_centimetre() -> None:
    """Both feet stand, and the weight goes a little from one to the other."""
    robot = hrp2.robot()
    played = rolled(planned_part("Tilt3", robot), robot, SETTLED)
    log = record(played, robot, SENSORS.physics(PAPER), SENSORS, 0).log
    assert list(check_balance(robot, log)) == []
    (finding,) = check_balance(robot, with_feet_exchanged(log))
    assert (finding.code, finding.fatal) == ("swapped_feet", True)


@pytest.mark.parametrize(("scale", "code"), [(1.0, "swapped_feet"), (1000.0, "torque_unit")])
def test_moments_of_exchanged_feet_are_no_unit(scale: float, code: str) -> None:
    """Of a weight that goes from foot to foot the torques are a small part."""
    log = walked()
    assert list(check_balance(hrp2.robot(), log)) == []
    torques = {name: scale * log.column(name) for name in log.columns if ".torque." in name}
    (finding,) = check_balance(hrp2.robot(), with_feet_exchanged(log.with_columns(torques)))
    assert (finding.code, finding.fatal) == (code, True)


@pytest.mark.parametrize(
    ("left", "unit", "code"),
    [(0.01, False, "swapped_feet"), (0.2, False, "torque_unit"), (0.01, True, "torque_unit")],
)
def test_a_unit_is_told_where_exchanged_feet_do_not_explain_it(
    monkeypatch: pytest.MonkeyPatch, tilt: MotionLog, left: float, unit: bool, code: str
) -> None:
    stance, as_read = Mock(robot=hrp2.robot()), Mock(misfit=0.3, moving=0.1, lean=0.0)
    stance.sides.return_value = as_read
    stance.exchanged_wrenches.return_value.sides.return_value = Mock(misfit=left, moving=0.1)
    stance.world_wrenches.return_value.sides.return_value = Mock(misfit=0.3, moving=0.1)
    stance.sole_wrenches.return_value.sides.return_value = Mock(misfit=0.3, moving=0.1)
    monkeypatch.setattr(StanceChanges, "quarter_turn", None)
    monkeypatch.setattr(standing, "stance_of", lambda *_: stance)
    found = Finding("torque_unit", "columns 'wrench.*.torque.*': torques 8.4 times as large", True)
    monkeypatch.setattr(
        standing, "torque_unit", lambda *given: [found] if unit or given[2] is as_read else []
    )
    assert [one.code for one in check_balance(hrp2.robot(), tilt)] == [code]


def test_all_torques_reversed_are_told(sway: MotionLog) -> None:
    torques = [name for name in sway.columns if ".torque." in name]
    findings = check_balance(hrp2.robot(), reversed_(sway, *torques))
    assert any("columns 'wrench.*.torque.*'" in one.text for one in findings if one.code == "sign")


@pytest.mark.parametrize(("left", "told"), [(0.01, True), (0.08, False)])
def test_a_reversed_joint_that_explains_as_much_as_swapped_wrenches_is_named_with_them(
    monkeypatch: pytest.MonkeyPatch, tilt: MotionLog, left: float, told: bool
) -> None:
    """Of a robot on one foot, whose ankle's roll moves the centre of mass as far as the other foot is."""
    stance = Mock(robot=hrp2.robot())
    still = np.zeros((20, 3))
    stance.sides.return_value = Mock(
        misfit=0.3, moving=0.1, lean=0.0, moment_arms=np.zeros((20, 2, 6, 3)), up=still, push=still
    )
    stance.exchanged_wrenches.return_value.sides.return_value = Mock(misfit=0.02, moving=0.1)
    stance.world_wrenches.return_value.sides.return_value = Mock(misfit=0.3, moving=0.1)
    stance.sole_wrenches.return_value.sides.return_value = Mock(misfit=0.3, moving=0.1)
    monkeypatch.setattr(standing, "stance_of", lambda *_: stance)
    monkeypatch.setattr(StanceChanges, "_reversed_joints", lambda _: {"column 'joint.ankle.position'": left})
    monkeypatch.setattr(StanceChanges, "_reversed_components", lambda _: {})
    monkeypatch.setattr(StanceChanges, "misread_joints", lambda *_: {})
    monkeypatch.setattr(StanceChanges, "quarter_turn", None)
    (finding,) = check_balance(hrp2.robot(), tilt)
    assert finding.code == "swapped_feet"
    assert ("or column 'joint.ankle.position' is reversed" in finding.text) == told


@pytest.mark.parametrize("rpy", [(0.15, 0.0, 0.0), (0.0, -0.15, 0.0), (np.pi / 2, 0.0, 0.0)])
def test_an_imu_mounted_otherwise_shows_in_the_ground_s_force(
    tilt: MotionLog, rpy: tuple[float, float, float]
) -> None:
    robot = hrp2.robot()
    assert robot.imu is not None
    placement = replace(robot.imu.placement, rpy=robot.imu.placement.rpy + np.array(rpy))
    wrong = replace(robot, imu=replace(robot.imu, placement=placement))
    (finding,) = [one for one in check_log(wrong, tilt) if one.code == "force_leans"]
    assert float(finding.text.split("leans ")[1].split(" deg")[0]) == pytest.approx(
        np.degrees(max(map(abs, rpy))), abs=1.5
    )
    assert finding.fatal == (max(rpy) > 1)


def test_a_turned_imu_is_told(sway: MotionLog) -> None:
    robot = hrp2.robot()
    assert robot.imu is not None
    placement = replace(robot.imu.placement, rpy=robot.imu.placement.rpy + np.array([0.0, 0.0, np.pi]))
    wrong = replace(robot, imu=replace(robot.imu, placement=placement))
    (finding,) = [one for one in check_log(wrong, sway) if one.code in ("imu_turned", "force_leans")]
    assert "check the IMU's link and rpy" in finding.text


@pytest.mark.parametrize("degrees", [90, 180, -90])
@pytest.mark.parametrize("feet", [["right"], ["left", "right"]])
def test_force_sensors_that_are_turned_are_told_by_as_much(degrees: int, feet: list[str]) -> None:
    """A turn of all sensors by half a turn is more than the reversed component that it looks like."""
    robot = hrp2.robot()
    wrong = dict(robot.feet)
    for foot in feet:
        wrench = wrong[foot].wrench
        rpy = (np.array(wrench.placement.rpy) + [0.0, 0.0, np.radians(degrees)]).tolist()
        wrong[foot] = replace(
            wrong[foot], wrench=replace(wrench, placement=replace(wrench.placement, rpy=rpy))
        )
    findings = check_log(replace(robot, feet=wrong), walked())
    (finding,) = [one for one in findings if one.code in ("wrench_turned", "sign", "imu_turned")]
    assert finding.code == "wrench_turned"
    which = "'wrench.*'" if len(feet) == 2 else "'wrench.right_foot.*'"
    assert f"columns {which}: turned by {degrees if degrees == 180 else -degrees:+d} deg" in finding.text


@pytest.mark.parametrize(("degrees", "told"), [(8.0, False), (13.0, True), (-13.0, True)])
def test_an_imu_turned_about_the_vertical_is_told_from_ten_degrees_on(
    sway: MotionLog, degrees: float, told: bool
) -> None:
    robot = hrp2.robot()
    assert robot.imu is not None
    turned = robot.imu.placement.rpy + np.array([0.0, 0.0, np.radians(degrees)])
    wrong = replace(robot, imu=replace(robot.imu, placement=replace(robot.imu.placement, rpy=turned)))
    findings = [one for one in check_balance(wrong, sway) if one.code == "imu_turned"]
    assert len(findings) == told
    for one in findings:
        size = float(one.text.split("directions that are ")[1].split(" deg apart")[0])
        assert abs(size) == pytest.approx(abs(degrees), abs=2.0)


def test_what_a_reversal_mends_is_told_in_centimetres(sway: MotionLog) -> None:
    wrong = reversed_(sway, "wrench.right_foot.torque.x")
    before, after = (standing.stance_of(hrp2.robot(), log) for log in (wrong, sway))
    assert before is not None
    assert after is not None
    (finding,) = [one for one in found(wrong) if one.code == "sign"]
    right, as_is = (100 * one.sides().misfit for one in (after, before))
    told, beside = (float(finding.text.split(word)[1].split()[0]) for word in ("gravity to", "instead of"))
    assert beside == pytest.approx(as_is, abs=0.06)
    assert 0.3 * right < told <= right + 0.06, "the best of what was tried"


@pytest.mark.parametrize(
    "column", ["imu.chest.angular_velocity.y", "imu.chest.orientation.x", "wrench.right_foot.torque.x"]
)
def test_a_channel_that_stops_is_told_with_its_time(sway: MotionLog, column: str) -> None:
    values = sway.column(column).copy()
    values[400:] = values[400]
    (finding,) = [one for one in found(sway.with_columns({column: values})) if one.code == "stuck_channel"]
    assert f"column '{column}', t = {sway.time[400]:g} to {sway.time[-1]:g} s" in finding.text


def test_a_wrench_that_stops_is_one_finding(sway: MotionLog) -> None:
    """A frozen sensor is one fault, not six."""
    parts = [name for name in sway.columns if name.startswith("wrench.right_foot.")]
    for first, said in ((400, "stand still"), (0, "never change")):
        columns = {name: sway.column(name).copy() for name in parts}
        for values in columns.values():
            values[first:] = values[first]
        codes = ("stuck_channel", "dead_channel", "dead_force")
        (finding,) = [one for one in found(sway.with_columns(columns)) if one.code in codes]
        assert finding.text.startswith("columns 'wrench.right_foot.*'")
        assert said in finding.text
    some = {name: values for name, values in columns.items() if name.endswith(("torque.x", "torque.y"))}
    (finding,) = [one for one in found(sway.with_columns(some)) if one.code == "dead_force"]
    assert "'wrench.right_foot.torque.x', 'wrench.right_foot.torque.y'" in finding.text


def test_a_force_at_full_scale_is_told(sway: MotionLog) -> None:
    torque = sway.column("wrench.right_foot.torque.x")
    full = 0.6 * float(np.max(np.abs(torque)))
    clipped = sway.with_columns({"wrench.right_foot.torque.x": np.clip(torque, -full, full)})
    assert any(one.code == "stuck_channel" and "torque.x" in one.text for one in found(clipped))


@pytest.mark.parametrize(
    ("kind", "late"), [("angular_velocity", 0.02), ("orientation", 0.02), ("orientation", 0.0)]
)
def test_a_gyroscope_and_an_orientation_of_different_moments_are_told(
    sway: MotionLog, kind: str, late: float
) -> None:
    rows = round(late / sway.period)
    columns = {name: np.roll(values, rows) for name, values in sway.columns.items() if f".{kind}." in name}
    findings = [
        one for one in found(sway.with_columns(columns).select(slice(rows, None))) if one.code == "imu_late"
    ]
    if late == 0:
        assert findings == []
    else:
        (finding,) = findings
        told = "gyroscope" if kind == "angular_velocity" else "orientation"
        assert f"the {told} is 20 ms behind" in finding.text or f"the {told} is 19 ms behind" in finding.text
