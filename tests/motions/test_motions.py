"""The campaign's motions: they do what the paper says, and what cannot be done is refused in one line."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from example_robots import G1, talos_file
from plantar.errors import MotionError
from plantar.motions import CAMPAIGN, DEMO, FIT, Plan, plan_motion, planned_balance
from plantar.motions.profile import bows, cycles, smooth_step, sweep, window
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.robots import hrp2
from twin_samples import plan


def poses(robot: RobotModel, plan: Plan, link: str, every: int = 200) -> np.ndarray:
    """Poses (n, 4, 4) of a URDF link in the world, by Pinocchio on the robot's own URDF."""
    model, data = robot.model, robot.model.createData()
    found = []
    for row in range(0, len(plan.time), every):
        q = pin.neutral(model)
        for name, value in zip(plan.joints, plan.positions[row], strict=True):
            q[model.joints[model.getJointId(name)].idx_q] = value
        pin.framesForwardKinematics(model, data, q)
        found.append(plan.base[row] @ data.oMf[model.getFrameId(link)].homogeneous)
    return np.array(found)


def test_the_campaign_is_the_papers() -> None:
    assert len(CAMPAIGN) == 14
    assert set(FIT) < set(DEMO) < set(CAMPAIGN)
    assert FIT == (
        "Manual_right_roll",
        "Manual_right_pitch",
        "Manual_left_roll",
        "Manual_left_pitch",
        "Tilt3",
    )


@pytest.mark.slow
@pytest.mark.parametrize("motion", CAMPAIGN)
def test_every_motion_keeps_limits_feet_and_balance(motion: str) -> None:
    robot, played = hrp2.robot(), plan(motion)
    model = robot.model
    speeds = np.gradient(played.positions, played.time, axis=0)
    for place, name in enumerate(played.joints):
        joint = model.joints[model.getJointId(name)]
        low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
        assert (
            low - 1e-3 <= played.positions[:, place].min() <= played.positions[:, place].max() <= high + 1e-3
        )
        assert np.abs(speeds[:, place]).max() <= model.upperVelocityLimit[joint.idx_v]
    for side in played.standing:
        ankle = poses(robot, played, f"{side[0].upper()}LEG_LINK5")
        assert np.ptp(ankle[:, :3, 3], axis=0).max() < 5e-4
        assert ankle[:, 2, 3] == pytest.approx(np.full(len(ankle), 0.105), abs=5e-4)
        assert ankle[:, 2, 2].min() > 1 - 1e-6
    for side in {"left", "right"} - played.standing:
        assert poses(robot, played, f"{side[0].upper()}LEG_LINK5")[:, 2, 3].min() > 0.105 + 0.07
    time, margin = planned_balance(robot, played).worst()
    assert margin > 0.005
    assert 0 <= time <= played.time[-1]


def test_tilt_sways_two_centimetres_twice_each_way() -> None:
    chest = poses(hrp2.robot(), plan("Tilt1"), "CHEST_LINK1", every=10)[:, :3, 3]
    moved = chest - chest[0]
    assert np.ptp(moved[:, 0]) == pytest.approx(0.04, abs=1e-3)
    assert np.ptp(moved[:, 1]) == pytest.approx(0.04, abs=1e-3)
    assert np.abs(moved[:, 2]).max() < 1e-3
    time = plan("Tilt1").time[::10]
    for axis, start in ((0, 2.0), (1, 22.0)):  # forward and backward first, then left and right, 10 s each
        inside = (time > start) & (time < start + 20)
        assert np.abs(moved[~inside, axis]).max() < 1e-3
        peaks = np.diff(np.sign(np.diff(np.where(np.abs(moved[:, axis]) > 0.015, moved[:, axis], 0.0))))
        turns = np.flatnonzero(peaks * np.sign(moved[1:-1, axis]) < -1)
        assert len(turns) == 4


def test_tilt4_goes_down_seven_centimetres() -> None:
    chest = poses(hrp2.robot(), plan("Tilt4"), "CHEST_LINK1", every=10)[:, 2, 3]
    assert np.ptp(chest) == pytest.approx(0.07, abs=1e-3)


@pytest.mark.parametrize(("motion", "step"), [("Tilt1", (0, 0)), ("Tilt2", (0, -0.05)), ("Tilt3", (0.1, 0))])
def test_states_of_the_legs(motion: str, step: tuple[float, float]) -> None:
    soles = plan(motion).stance
    apart = soles["right"][:2, 3] - soles["left"][:2, 3]
    assert apart == pytest.approx(np.array([0.0, -0.19]) + step, abs=1e-6)


def test_manual_sways_stand_on_the_named_foot_and_lead_by_hand() -> None:
    for motion, foot, axis in (("Manual_right_roll", "right", 1), ("Manual_left_pitch", "left", 0)):
        played = plan(motion)
        assert played.standing == {foot}
        assert np.ptp(played.positions, axis=0).max() < 1e-9
        swing = np.ptp(played.hand.path, axis=0)
        assert swing[axis] > 3 * swing[1 - axis]
    assert plan("Manual_both_pitch").standing == {"left", "right"}


def test_sweeps_move_the_upper_limbs_and_nothing_else() -> None:
    first, second = plan("Myrand4"), plan("Myrand5")
    moved = {
        name for name, way in zip(first.joints, np.ptp(first.positions, axis=0), strict=True) if way > 0.05
    }
    assert not any("LEG" in name for name in moved)
    assert {name for name in first.joints if "ARM" in name} <= moved
    assert not np.array_equal(first.positions, second.positions)


def test_arms_lead_the_zmp_of_any_robot_about_a_third_of_the_way(tmp_path) -> None:
    """Farther, and a robot on bushes falls where the sweep passes its resonance."""
    for robot in (hrp2.robot(), load_robot(talos_file(tmp_path))):
        played = plan("Myrand5") if robot.name == "hrp2" else plan_motion("Myrand5", robot)
        balance = planned_balance(robot, played)
        led = np.abs(balance.zmp - balance.zmp[0]).max(axis=0) / (np.ptp(balance.polygon, axis=0) / 2)
        assert 0.25 < led.max() < 0.33


def test_a_plan_starts_and_ends_at_rest() -> None:
    for motion in ("Tilt6", "Squat", "Myrand4"):
        speeds = np.gradient(plan(motion).positions, 0.005, axis=0)
        assert np.abs(speeds[[0, -1]]).max() < 5e-3


@pytest.mark.parametrize(
    ("motion", "options", "message"),
    [
        (
            "Tilt9",
            {},
            r"^unknown motion 'Tilt9' \(valid: Tilt1, Tilt2, Tilt3, Tilt4, Tilt5, Tilt6, "
            r"Manual_right_roll, Manual_right_pitch, Manual_left_roll, Manual_left_pitch, "
            r"Manual_both_pitch, Myrand4, Myrand5, Squat, Walk8, Walk12, Walk16, Walk20, WalkSlow8, "
            r"WalkSlow12, WalkQuick8, WalkQuick12, WalkTurn, WalkInPlace\)$",
        ),
        (
            "Tilt1",
            {"sway": 0.12},
            r"t = [\d.]+ s: Tilt1: the zero-moment point leaves the support polygon by [\d.]+ mm",
        ),
        (
            "Tilt1",
            {"sway": 0.5},
            r"t = [\d.]+ s: Tilt1: .*cannot reach its place, it (misses|falls short) by",
        ),
        ("Squat", {"vertical": 0.6}, r"t = [\d.]+ s: Squat: .*cannot reach its place"),
        (
            "Tilt1",
            {"apart": 0.08},  # soles are 138 mm wide
            r"^hrp2_like: the soles would stand on each other, 58 mm deep \(valid: feet farther "
            r"apart\)$",
        ),
        ("Manual_right_roll", {"sway": 0.2}, r"t = [\d.]+ s: Manual_right_roll: .*polygon by [\d.]+ mm"),
    ],
)
def test_what_cannot_be_played_is_refused(motion: str, options: dict[str, float], message: str) -> None:
    with pytest.raises(MotionError, match=message) as caught:
        plan_motion(motion, hrp2.robot(), hrp2.postures(), **options)
    assert "\n" not in str(caught.value)


def test_a_limit_of_speed_and_one_of_torque_are_held(tmp_path) -> None:
    file = hrp2.write(tmp_path)
    urdf = (tmp_path / "hrp2.urdf").read_text()
    for old, new, message in (
        (
            'velocity="5.5"',
            'velocity="0.01"',
            r"^t = 5\.16 s: Squat: joint 'LLEG_JOINT3' passes its speed limit by 0\.476 \(valid: at "
            r"most 0\.01 rad/s\)$",
        ),
        ('effort="260"', 'effort="5"', r"LEG_JOINT[23]' needs [\d.]+ N·m .valid: at most 5 N·m"),
    ):
        assert old in urdf
        (tmp_path / "hrp2.urdf").write_text(urdf.replace(old, new))
        with pytest.raises(MotionError, match=message):
            plan_motion("Squat", load_robot(file), hrp2.postures())


@pytest.mark.parametrize("motion", ["Tilt5", "Manual_right_pitch", "Squat"])
def test_other_bipeds_move_too(motion: str, tmp_path) -> None:
    for robot in (load_robot(talos_file(tmp_path)), load_robot(g1_file(tmp_path))):
        played = plan_motion(motion, robot)
        for side in played.standing:
            frame = robot.feet[side].ankle
            ankle = poses(robot, played, frame)
            assert np.ptp(ankle[:, :3, 3], axis=0).max() < 1e-3
            assert ankle[:, 2, 2].min() > 1 - 1e-5
        assert planned_balance(robot, played).worst()[1] > 0.005


def test_a_robot_without_two_feet_is_refused(tmp_path) -> None:
    file = hrp2.write(tmp_path)
    file.write_text(file.read_text().replace("  left:", "  third:"))
    with pytest.raises(
        MotionError,
        match=r"robot\.yaml: motions are planned for a left and a right foot and a chest that carries "
        r"an IMU \(valid: a robot file with imu, left and right\)$",
    ):
        plan_motion("Tilt1", load_robot(file))


def test_profiles() -> None:
    time = np.linspace(0, 50, 5001)
    assert smooth_step(np.array([-1.0, 0.0, 0.5, 1.0, 2.0])) == pytest.approx([0, 0, 0.5, 1, 1])
    sway = cycles(time, 5.0, 10.0, 2)
    assert not sway[time < 5].any()
    assert not sway[time > 25].any()
    assert np.abs(sway).max() == pytest.approx(1.0, abs=1e-3)
    assert bows(time, 5.0, 10.0, 2).max() == pytest.approx(1.0)
    assert window(time, 5.0, 25.0, 2.0)[time == 15] == 1.0
    late = sweep(time, 20.0, 30.0, 0.1, 0.3)
    quick = (time > 22) & (time < 28)  # where nothing is eased
    along = time[quick] - 20
    assert late[quick] == pytest.approx(np.sin(2 * np.pi * (0.1 * along + 0.01 * along**2)))
    assert not late[(time <= 20) | (time >= 30)].any()
    swept = sweep(time, 0.0, 50.0, 0.1, 0.5)
    crossings = np.flatnonzero(np.diff(np.sign(swept)))
    assert len(crossings) == pytest.approx(2 * 50 * 0.3, abs=2)  # twice the mean frequency


def g1_file(folder):
    feet = "".join(
        f"""  {side}:
    ankle: {side}_ankle_roll_link
    bush: {{xyz: [0.03, 0, -0.02]}}
    wrench: {{name: {side}, xyz: [0.03, 0, -0.02]}}
    sole: {{xyz: [0.03, 0, -0.035], polygon: [[0.09, 0.03], [-0.08, 0.025], [-0.08, -0.025], [0.09, -0.03]]}}
"""
        for side in ("left", "right")
    )
    path = folder / "g1.yaml"
    path.write_text(f"name: g1\nurdf: {G1}\nimu: {{name: torso, link: imu_in_torso}}\nfeet:\n{feet}")
    return path
