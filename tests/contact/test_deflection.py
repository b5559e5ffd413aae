"""Bush deflection against a per-sample oracle in Pinocchio and NumPy, and against finite differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

import example_robots
from plantar import _core
from plantar.contact.deflection import BushState, bush_states, foot_motions, onto_sole
from plantar.contact.relative_pose import relative_pose
from plantar.conventions import Array, rotation_from_rpy
from plantar.errors import DataError, RobotError
from plantar.robot.model import Foot, Imu, Placement, RobotModel, Sole, WrenchSensor

QUANTITIES = ("deflection", "rate", "wrench", "torque", "force_z", "sole_position", "heading")
SAMPLES = 43  # not a multiple of any vector's length


def robot(urdf: Path, imu: str, ankles: dict[str, str], seed: int) -> RobotModel:
    """A robot with its IMU, bushes, sensors and soles mounted at random."""
    rng = np.random.default_rng(seed)

    def placement(link: str, angle: float) -> Placement:
        return Placement(link, rng.uniform(-0.2, 0.2, 3), rng.uniform(-angle, angle, 3))

    square = np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])
    feet = {
        name: Foot(
            name,
            ankle,
            placement(ankle, 0.5),
            WrenchSensor(name, placement(ankle, 3.0), -1.0 if name == "right" else 1.0),
            Sole(placement(ankle, 0.5), square),
            "auto",
        )
        for name, ankle in ankles.items()
    }
    mounted = Imu("imu", placement(imu, 3.0))
    return RobotModel("robot", urdf, urdf, urdf.read_text(), "floating", mounted, feet, {}, {}, {})


def talos(seed: int = 0) -> RobotModel:
    ankles = {"left": "leg_left_6_link", "right": "leg_right_6_link"}
    return robot(example_robots.TALOS, "torso_2_link", ankles, seed)


def humanoid(seed: int = 1) -> RobotModel:
    return robot(example_robots.HUMANOID, "torso", {"left": "l_ankle", "right": "r_ankle"}, seed)


def motion(model: RobotModel, seed: int, samples: int = SAMPLES) -> dict[str, Array]:
    rng = np.random.default_rng(seed)
    joints = len(model.joint_names)
    return {
        "positions": rng.uniform(-0.6, 0.6, (samples, joints)),
        "velocities": rng.normal(0, 1, (samples, joints)),
        "orientation": rng.normal(0, 1, (samples, 4)),
        "angular_velocity": rng.normal(0, 1, (samples, 3)),
    }


def states(model: RobotModel, moved: dict[str, Array], wrenches: dict[str, Array]) -> dict[str, BushState]:
    return bush_states(model, **moved, wrenches=wrenches)


def oracle(model: RobotModel, moved: dict[str, Array], wrenches: dict[str, Array], i: int) -> dict[str, dict]:
    """One sample from first principles: frames by Pinocchio, the law of the wrench by hand."""
    pinocchio, data = model.floating_model, model.floating_model.createData()
    w, x, y, z = moved["orientation"][i] / np.linalg.norm(moved["orientation"][i])
    assert model.imu is not None

    def frame_in_joint(placement: Placement) -> tuple[int, pin.SE3]:
        frame = pinocchio.frames[pinocchio.getFrameId(placement.link)]
        return frame.parentJoint, frame.placement * pin.SE3(rotation_from_rpy(placement.rpy), placement.xyz)

    # The base so that the IMU has the measured attitude and angular velocity, its origin at the world's.
    q = np.concatenate([np.zeros(6), [1.0], moved["positions"][i]])
    v = np.concatenate([np.zeros(6), moved["velocities"][i]])
    joint, mount = frame_in_joint(model.imu.placement)
    pin.forwardKinematics(pinocchio, data, q, v)
    in_base = data.oMi[joint] * mount
    base = pin.SE3(pin.Quaternion(w, x, y, z).toRotationMatrix(), np.zeros(3)) * in_base.inverse()
    q[:7] = pin.SE3ToXYZQUAT(base)
    missing = moved["angular_velocity"][i] - mount.actInv(data.v[joint]).angular
    v[3:6] = in_base.rotation @ missing
    pin.forwardKinematics(pinocchio, data, q, v)
    assert np.allclose(mount.actInv(data.v[joint]).angular, moved["angular_velocity"][i])
    answer = {}
    for name, foot in model.feet.items():
        joint, bush = frame_in_joint(foot.bush)
        world = data.oMi[joint] * bush
        up = world.rotation.T @ np.array([0, 0, 1.0])
        pitch, roll = np.arctan2(up[0], up[2]), -np.arcsin(up[1])
        up_rate = -np.cross(bush.actInv(data.v[joint]).angular, up)
        level2 = up[0] ** 2 + up[2] ** 2
        rate = [(up[2] * up_rate[0] - up[0] * up_rate[2]) / level2, -up_rate[1] / np.sqrt(1 - up[1] ** 2)]
        deflected = pin.SE3(rotation_from_rpy(np.array([0, pitch, 0])), np.zeros(3)) * pin.SE3(
            rotation_from_rpy(np.array([roll, 0, 0])), np.zeros(3)
        )
        sensor = bush.inverse() * frame_in_joint(foot.wrench.placement)[1]
        wrench = sensor.act(pin.Force(foot.wrench.sign * wrenches[name][i]))
        axis = rotation_from_rpy(np.array([0, pitch, 0]))[:, 0]
        sole_rest = bush.inverse() * frame_in_joint(foot.sole.placement)[1]
        sole = deflected * sole_rest
        on_sole = sole.actInv(wrench)
        in_world = world * sole
        answer[name] = {
            "deflection": [pitch, roll],
            "rate": rate,
            "wrench": wrench.vector,
            "torque": [wrench.angular[1], wrench.angular @ axis],
            "force_z": (world.rotation @ wrench.linear)[2],
            "cop": np.array([-on_sole.angular[1], on_sole.angular[0]]) / (on_sole.linear[2] or np.nan),
            "carries": on_sole.linear[2] >= 0.02 * model.mass * 9.80665,
            "sole_position": in_world.translation,
            "heading": np.arctan2(in_world.rotation[1, 0], in_world.rotation[0, 0]),
            "sole": in_world,
        }
    return answer


@pytest.mark.parametrize("make", [talos, humanoid])
def test_every_quantity_agrees_with_pinocchio_to_1e_10(make: object) -> None:
    for seed in range(3):
        model = make(seed)  # type: ignore[operator]
        moved = motion(model, seed + 10)
        rng = np.random.default_rng(seed)
        wrenches = {name: rng.normal(0, 300, (SAMPLES, 6)) for name in model.feet}
        found = states(model, moved, wrenches)
        for i in range(SAMPLES):
            expected = oracle(model, moved, wrenches, i)
            for name, state in found.items():
                for key in QUANTITIES:
                    value = getattr(state, key)[i]
                    np.testing.assert_allclose(
                        value, expected[name][key], rtol=1e-10, atol=1e-10, err_msg=key
                    )
                if expected[name]["carries"]:
                    np.testing.assert_allclose(state.cop[i], expected[name]["cop"], rtol=1e-10, atol=1e-10)
                else:
                    assert np.isnan(state.cop[i]).all()


def test_closure_agrees_with_the_relative_pose_of_level_soles() -> None:
    model = talos(4)
    moved = motion(model, 5)
    none = {name: np.zeros((SAMPLES, 6)) for name in model.feet}
    found = states(model, moved, none)
    closed = relative_pose(found["left"], found["right"])
    for i in range(SAMPLES):
        soles = {name: answer["sole"] for name, answer in oracle(model, moved, none, i).items()}
        forward = {name: sole.rotation[:, 0] for name, sole in soles.items()}
        yaw = {name: np.arctan2(axis[1], axis[0]) for name, axis in forward.items()}
        to_left = rotation_from_rpy(np.array([0, 0, -yaw["left"]]))
        apart = to_left @ (soles["right"].translation - soles["left"].translation)
        np.testing.assert_allclose(closed.position[i], apart, atol=1e-10)
        turned = np.exp(1j * (yaw["right"] - yaw["left"]))
        np.testing.assert_allclose(np.exp(1j * closed.yaw[i]), turned, atol=1e-10)
    assert (np.abs(closed.yaw) <= np.pi).all()


def test_the_imus_yaw_enters_neither_angles_nor_closure() -> None:
    model = talos(6)
    moved = motion(model, 7)
    none = {name: np.zeros((SAMPLES, 6)) for name in model.feet}
    before = states(model, moved, none)
    w, x, y, z = moved["orientation"].T
    c, s = np.cos(0.7), np.sin(0.7)
    turned = np.column_stack([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w])
    after = states(model, {**moved, "orientation": turned}, none)
    np.testing.assert_allclose(after["left"].deflection, before["left"].deflection, atol=1e-12)
    np.testing.assert_allclose(
        relative_pose(after["left"], after["right"]).position,
        relative_pose(before["left"], before["right"]).position,
        atol=1e-12,
    )


def test_rates_are_the_derivatives_of_the_angles() -> None:
    """Central differences along a smooth motion with consistent gyroscope and encoders."""
    model = humanoid(8)
    rng = np.random.default_rng(9)
    joints = len(model.joint_names)
    amplitude, phase = rng.uniform(0, 0.3, joints), rng.uniform(0, 6, joints)
    step, time = 1e-4, np.arange(200) * 1e-4
    positions = amplitude * np.sin(3 * time[:, None] + phase)
    velocities = 3 * amplitude * np.cos(3 * time[:, None] + phase)
    spin = np.array([0.4, -0.3, 0.8])
    attitude = [pin.Quaternion(pin.exp3(spin * t)) for t in time]
    orientation = np.array([[a.w, a.x, a.y, a.z] for a in attitude])
    moved = {
        "positions": positions,
        "velocities": velocities,
        "orientation": orientation,
        "angular_velocity": np.tile(spin, (len(time), 1)),
    }
    found = states(model, moved, {name: np.zeros((len(time), 6)) for name in model.feet})
    for state in found.values():
        slope = (state.deflection[2:] - state.deflection[:-2]) / (2 * step)
        np.testing.assert_allclose(state.rate[1:-1], slope, atol=1e-7)


def test_encoders_have_their_part_in_the_rates() -> None:
    model = talos()
    moved = motion(model, 5)
    whole = foot_motions(model, **moved)
    held = foot_motions(model, **{**moved, "angular_velocity": np.zeros((SAMPLES, 3))})
    for name in model.feet:
        assert np.abs(whole[name].rate - whole[name].encoder_rate).max() > 0.1
        np.testing.assert_allclose(whole[name].encoder_rate, held[name].rate, atol=1e-13)


def test_a_known_deflection_comes_back() -> None:
    """A foot held level while the ankle pitches and rolls: the angles are those put in, with their signs."""
    rest = np.zeros(3)
    square = np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])
    urdf = '<robot name="foot"><link name="ankle"/></robot>'
    at = Placement("ankle", rest, rest)
    sole = Sole(Placement("ankle", np.array([0, 0, -0.1]), rest), square)
    foot = Foot("left", "ankle", at, WrenchSensor("left", at, 1.0), sole, "auto")
    path = Path("foot.urdf")
    model = RobotModel("foot", path, path, urdf, "floating", Imu("imu", at), {"left": foot}, {}, {}, {})
    pitch, roll = 0.05, -0.03
    bent = rotation_from_rpy(np.array([0, pitch, 0])) @ rotation_from_rpy(np.array([roll, 0, 0]))
    ankle = pin.Quaternion(bent.T)  # the sole's frame is the world's
    moved = {
        "positions": np.zeros((1, 0)),
        "velocities": np.zeros((1, 0)),
        "orientation": np.array([[ankle.w, ankle.x, ankle.y, ankle.z]]),
        "angular_velocity": np.zeros((1, 3)),
    }
    # The ground pushes up 20 mm in front of and 10 mm left of the sole's origin.
    force = bent @ np.array([0, 0, 100.0])
    arm = bent @ np.array([0.02, 0.01, -0.1])
    wrench = np.concatenate([force, np.cross(arm, force)])[None]
    state = states(model, moved, {"left": wrench})["left"]
    np.testing.assert_allclose(state.deflection[0], [pitch, roll], atol=1e-14)
    np.testing.assert_allclose(state.cop[0], [0.02, 0.01], atol=1e-13)
    np.testing.assert_allclose(state.force_z[0], 100.0, rtol=1e-13)
    np.testing.assert_allclose(state.heading[0], 0.0, atol=1e-14)


def test_every_instruction_set_and_thread_count_agree() -> None:
    rng = np.random.default_rng(2)
    samples, joints = 5003, 3
    frame = np.concatenate([rotation_from_rpy(rng.normal(size=3)).ravel(), rng.normal(size=3)])
    rows = rng.uniform(-3, 3, (samples, 2 * joints))
    arguments = (
        [frame] * joints,
        [False, True, False],
        [1.0, -1.0, 1.0],
        frame,
        frame,
        [rows[:, j] for j in range(joints)],
        [rows[:, joints + j] for j in range(joints)],
        rng.normal(size=(samples, 4)),
        rng.normal(size=(samples, 3)),
    )
    assert _core.instruction_sets()[-1] == "baseline"
    reference = _core.foot_chain(*arguments, threads=1, isa="baseline")
    for isa in _core.instruction_sets():
        for threads in (1, 3):
            np.testing.assert_allclose(
                _core.foot_chain(*arguments, threads=threads, isa=isa), reference, rtol=1e-12, atol=1e-12
            )
    load = (frame, -1.0, 100 * rng.normal(size=(samples, 6)), reference[:3].T, frame, 50.0)
    reference = _core.sole_load(*load, threads=1, isa="baseline")
    assert np.isnan(reference).any()
    assert not np.isnan(reference[:9]).any()
    for isa in _core.instruction_sets():
        for threads in (1, 3):
            np.testing.assert_allclose(
                _core.sole_load(*load, threads=threads, isa=isa), reference, rtol=1e-12, atol=1e-10
            )


def test_large_and_missing_angles_keep_their_meaning() -> None:
    """Many turns are as good as none; NaN stays in its own sample."""
    model = talos(3)
    moved = motion(model, 3, 16)
    none = {name: np.zeros((16, 6)) for name in model.feet}
    before = states(model, moved, none)["left"].deflection
    turned = moved["positions"].copy()
    turned[4] += 2 * np.pi * 1e3
    turned[5] += 2 * np.pi * 1e6
    turned[9] = np.nan
    after = states(model, {**moved, "positions": turned}, none)["left"].deflection
    assert np.isnan(after[9]).all()
    keep = np.arange(16) != 9
    np.testing.assert_allclose(after[keep], before[keep], atol=1e-8)
    far = moved["positions"] + 10.0 ** np.linspace(0, 9, 16)[:, None]
    near = np.arctan2(np.sin(far), np.cos(far))
    after, before = (
        states(model, {**moved, "positions": turned}, none)["left"].deflection for turned in (far, near)
    )
    np.testing.assert_allclose(after, before, atol=1e-12, err_msg="as good as their sines and cosines")


def test_bad_arrays_and_a_robot_without_imu_are_named() -> None:
    model = talos()
    moved = motion(model, 1, 8)
    wrenches = {name: np.zeros((8, 6)) for name in model.feet}
    with pytest.raises(DataError, match=r"^velocities: an array of shape \(8, 31\) \(valid: \(8, 32\)\)$"):
        states(model, {**moved, "velocities": moved["velocities"][:, :-1]}, wrenches)
    with pytest.raises(
        DataError, match=r"^wrench of foot 'right': an array of shape \(8, 3\) \(valid: \(8, 6\)\)$"
    ):
        states(model, moved, {**wrenches, "right": np.zeros((8, 3))})
    blind = RobotModel("robot", model.path, model.path, model.urdf, "floating", None, model.feet, {}, {}, {})
    with pytest.raises(
        RobotError, match=r"talos_reduced\.urdf: names no imu \(valid: imu: \{name: \.\.\., link: \.\.\.\}\)$"
    ):
        states(blind, moved, wrenches)


def test_a_vector_seen_from_the_deflected_sole() -> None:
    random = np.random.default_rng(4)
    vector, pitch, roll = random.normal(size=(50, 3)), *random.uniform(-0.5, 0.5, (2, 50))
    turned = pin.utils.rotate("y", pitch[7]) @ pin.utils.rotate("x", roll[7])
    found = onto_sole(vector, pitch, roll)
    np.testing.assert_allclose(found[7], turned.T @ vector[7], atol=1e-15)
    back = Rotation.from_euler("YX", np.column_stack([pitch, roll])).apply(found)
    np.testing.assert_allclose(back, vector, atol=1e-14)
