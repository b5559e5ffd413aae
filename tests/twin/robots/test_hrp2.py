"""The HRP-2-like robot meets the published facts, seen through its URDF (Pinocchio) and its MJCF (MuJoCo)."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from plantar.robot.model import load_robot
from plantar.twin import PAPER
from plantar.twin.robots import hrp2
from plantar.twin.robots import hrp2_facts as facts
from plantar.twin.simulation.mjcf import Scene, mjcf_text

LEG = {  # right leg, lower and upper limit [rad]
    0: (-0.785, 0.524), 1: (-0.611, 0.349), 2: (-2.182, 0.733), 3: (-0.035, 2.618), 4: (-1.309, 0.733),
    5: (-0.349, 0.611),
}  # fmt: skip


@pytest.fixture(scope="module")
def model() -> pin.Model:
    return hrp2.robot().floating_model  # a fixed root would leave the waist's mass out


@pytest.fixture(scope="module")
def half_sitting(model: pin.Model) -> np.ndarray:
    q = pin.neutral(model)
    for name, angle in hrp2.half_sitting().items():
        q[model.joints[model.getJointId(name)].idx_q] = angle
    return q


def test_thirty_joints_in_the_published_order() -> None:
    names = [f"{side}LEG_JOINT{i}" for side in "RL" for i in range(6)]
    names += ["CHEST_JOINT0", "CHEST_JOINT1", "HEAD_JOINT0", "HEAD_JOINT1"]
    names += [f"{side}ARM_JOINT{i}" for side in "RL" for i in range(7)]
    assert list(hrp2.description().joint_names) == names
    axes = "".join("xyz"[int(np.argmax(np.abs(body.axis)))] for body in hrp2.description().bodies[1:])
    assert axes == "zxyyyx" * 2 + "zyzy" + "yxzyzyx" * 2


def test_leg_limits_and_their_mirror(model: pin.Model) -> None:
    for place, (low, high) in LEG.items():
        mirrored = place in (0, 1, 5)
        for side, expected in (("R", (low, high)), ("L", (-high, -low) if mirrored else (low, high))):
            index = model.joints[model.getJointId(f"{side}LEG_JOINT{place}")].idx_q
            assert (model.lowerPositionLimit[index], model.upperPositionLimit[index]) == pytest.approx(
                expected
            )


def test_mass_centre_and_inertia_at_half_sitting(model: pin.Model, half_sitting: np.ndarray) -> None:
    data = model.createData()
    pin.ccrba(model, data, half_sitting, np.zeros(model.nv))
    feet = [data.oMi[model.getJointId(f"{side}LEG_JOINT5")].translation for side in "RL"]
    middle = np.mean(feet, axis=0) + [0, 0, -0.105]
    assert hrp2.robot().mass == pytest.approx(56.87, rel=1e-6)
    assert data.com[0] - middle == pytest.approx(np.array([0.0136, 0.0015, 0.8077]), rel=0.02, abs=1e-4)
    assert np.diag(data.Ig.inertia) == pytest.approx(np.array([8.16, 6.94, 1.73]), rel=0.02)
    assert -middle[2] == pytest.approx(0.648702, abs=1e-6)
    assert abs(feet[0][1] - feet[1][1]) == pytest.approx(0.19)


def test_every_link_is_a_body_that_can_exist() -> None:
    for body in hrp2.description().bodies:
        moments = np.linalg.eigvalsh(body.inertia)
        assert body.mass > 0.1
        assert moments[0] > 0
        assert moments[0] + moments[1] > moments[2]


def test_sensors_sit_where_published() -> None:
    robot = hrp2.robot()
    joint, pose = robot.frame(robot.imu.placement)
    assert robot.model.names[joint] == "CHEST_JOINT1"
    assert pose.translation == pytest.approx([-0.13, 0, 0.118])
    sole = robot.feet["right"].sole
    assert np.ptp(sole.polygon, axis=0) == pytest.approx([0.2172, 0.138])
    assert robot.feet["right"].wrench.placement.xyz[2] == pytest.approx(-0.105)


def test_the_mjcf_is_the_same_robot(model: pin.Model, half_sitting: np.ndarray) -> None:
    simulated = mujoco.MjModel.from_xml_string(mjcf_text(hrp2.robot(), PAPER, Scene()))
    data = mujoco.MjData(simulated)
    data.qpos[3:7] = [1, 0, 0, 0]
    data.qpos[:3] = 0
    for name, angle in hrp2.half_sitting().items():
        data.joint(name).qpos = angle
    mujoco.mj_forward(simulated, data)
    assert simulated.body_mass.sum() == pytest.approx(hrp2.robot().mass, rel=1e-9)
    centre = pin.centerOfMass(model, model.createData(), half_sitting)
    assert data.subtree_com[0] == pytest.approx(centre, abs=1e-9)
    # gravity torques of every joint, Pinocchio against MuJoCo
    torque = pin.computeGeneralizedGravity(model, model.createData(), half_sitting)
    for name in hrp2.robot().joint_names:
        expected = torque[model.joints[model.getJointId(name)].idx_v]
        ours = data.qfrc_bias[simulated.joint(name).dofadr[0]]
        assert ours == pytest.approx(expected * 9.80665 / 9.81, rel=1e-6, abs=1e-9)


def test_mujoco_reads_the_scene_as_it_is_told() -> None:
    """A sole rubs alike in all directions, as only an elliptic cone has it; gravity is the one of the logs."""
    simulated = mujoco.MjModel.from_xml_string(mjcf_text(hrp2.robot(), PAPER, Scene(timestep=5e-4)))
    assert simulated.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    assert simulated.opt.timestep == 5e-4
    for body in hrp2.description().bodies[1:]:
        assert simulated.actuator(body.joint).forcerange == pytest.approx([-body.effort, body.effort])
    np.testing.assert_array_equal(simulated.opt.gravity, [0.0, 0.0, -9.80665])


def test_the_robot_file_reads_back(tmp_path) -> None:
    robot = load_robot(hrp2.write(tmp_path))
    assert set(robot.feet) == {"left", "right"}
    assert robot.joint_names == hrp2.robot().joint_names


def test_masses_are_scaled_in_mirrored_pairs_and_the_chest_grows_and_moves() -> None:
    """The waist by 2, both thighs by 3; the chest's box by 1.1, 1.2 and 1.3, its centre by -10 mm in z."""
    nominal = hrp2._nominal()
    keys = hrp2._symmetric_keys(nominal)
    assert len(keys) < len(nominal.bodies) == len({body.name for body in nominal.bodies})
    change = np.zeros(len(keys) + 6)
    change[keys.index("WAIST")], change[keys.index("LEG_LINK2")] = np.log(2.0), np.log(3.0)
    change[len(keys) :] = [*np.log([1.1, 1.2, 1.3]), 0.0, 0.0, -0.1]
    scaled = hrp2._scaled(nominal, change)
    for before, after in zip(nominal.bodies, scaled.bodies, strict=True):
        share = {"WAIST": 2.0, "RLEG_LINK2": 3.0, "LLEG_LINK2": 3.0}.get(before.name, 1.0)
        assert after.mass == pytest.approx(share * before.mass)
        (box,) = before.shapes
        chest = before.name == facts.IMU_LINK
        moved = np.array([0.0, 0.0, -0.01]) if chest else np.zeros(3)
        np.testing.assert_allclose(after.com, box.xyz + moved)
        grown = box.size * ([1.1, 1.2, 1.3] if chest else 1.0)
        across = np.array(
            [grown[1] ** 2 + grown[2] ** 2, grown[0] ** 2 + grown[2] ** 2, grown[0] ** 2 + grown[1] ** 2]
        )
        np.testing.assert_allclose(after.inertia, np.diag(after.mass / 12 * across), atol=1e-12)
