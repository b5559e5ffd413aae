"""Files for controllers that name no joints: their order is the robot file's, and mc_rtc's log is as it reads them."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import msgpack
import numpy as np
import pinocchio as pin
import pytest

import command_line
import design_samples
from plantar.design.trajectory import Trajectory
from plantar.design.writing.controllers import ordered_joints, write_mc_rtc, write_pos
from plantar.design.writing.outputs import check_outputs
from plantar.errors import SettingsError
from plantar.logs.readers import open_log
from plantar.robot.model import RobotModel
from plantar.twin.robots import hrp2

RATE = 100.0


@pytest.fixture(scope="module")
def motion() -> Trajectory:
    lines, moved = design_samples.reach().lines, 0.3 * design_samples.coefficients()
    return Trajectory.of("design", design_samples.legs(), lines, moved)


def told(motion: Trajectory, robot: RobotModel) -> Trajectory:
    """The same motion of a robot whose file says more."""
    legs = replace(motion.legs, body=type(motion.legs.body)(robot))
    return replace(motion, legs=legs)


def backwards() -> RobotModel:
    robot = hrp2.robot()
    ports = {"qOut": "joints.position"}
    return replace(robot, columns={"joints": list(reversed(robot.joint_names)), "ports": ports})


def entries(path: Path) -> list[list[object]]:
    """What stands in a binary log of mc_rtc's, version 0."""
    content = path.read_bytes()
    assert content[:4] == b"ANNE"
    place, found = 4, []
    while place < len(content):
        (size,) = struct.unpack_from("<Q", content, place)
        found.append(msgpack.unpackb(content[place + 8 : place + 8 + size]))
        place += 8 + size
    return found


def test_joints_stand_in_the_order_that_the_robot_file_tells(motion: Trajectory, tmp_path: Path) -> None:
    write_pos(motion, RATE, tmp_path / "own.pos")
    write_pos(told(motion, backwards()), RATE, tmp_path / "other.pos")
    own, other = (np.loadtxt(tmp_path / f"{name}.pos") for name in ("own", "other"))
    assert other[:, 0] == pytest.approx(own[:, 0])
    np.testing.assert_allclose(other[:, 1:], own[:, :0:-1], rtol=1e-6, atol=1e-12)


def test_mc_rtc_finds_what_its_replay_reads(motion: Trajectory, tmp_path: Path) -> None:
    path = tmp_path / "motion.bin"
    write_mc_rtc(told(motion, backwards()), RATE, path)
    (keys, first), *rest = entries(path)
    assert keys == ["t", "qOut", "qIn", "ff"]
    assert first[0::2] == [11, 21, 21, 18]
    assert all(entry[0] is None and entry[1][0::2] == first[0::2] for entry in rest)
    log = motion.log(RATE)
    assert len(rest) + 1 == len(log)
    # mc_rtc compares the first step with its own time step, without a tolerance.
    assert rest[0][1][1] - first[1] == 1 / RATE
    row = 1234
    _, (_, time, _, out, _, encoders, _, base) = entries(path)[row]
    assert time == pytest.approx(row / RATE)
    q = [log.columns[f"joint.{name}.position"][row] for name in reversed(hrp2.robot().joint_names)]
    assert out == pytest.approx(q) == encoders
    # The base as mc_rtc takes it puts both soles back where they stand, turned by no more than the ankles are.
    rotation, place = np.reshape(base[:9], (3, 3)).T, np.array(base[9:])
    legs = motion.legs
    body = legs.body
    whole = np.concatenate([place, pin.Quaternion(rotation).coeffs(), pin.neutral(body.model)[7:]])
    for name in body.joints:
        joint = body.model.joints[body.model.getJointId(name)]
        whole[joint.idx_q] = log.columns[f"joint.{name}.position"][row]
    for foot, frame in legs.bushes.items():
        pin.framesForwardKinematics(legs.model, legs.data, whole)
        found = legs.data.oMf[legs.model.getFrameId(frame)].translation
        assert found == pytest.approx(legs.rest[2][foot].translation, abs=1e-5)
    assert np.ptp([entry[1][7][:9] for entry in entries(path)], axis=0).max() > 1e-3  # the base does turn


def test_plantar_reads_its_own_mc_rtc_log(motion: Trajectory, tmp_path: Path) -> None:
    robot = backwards()
    path = tmp_path / "motion.bin"
    write_mc_rtc(told(motion, robot), RATE, path)
    np.testing.assert_allclose(
        open_log(path, robot).positions(robot), motion.log(RATE).positions(robot), rtol=1e-6, atol=1e-12
    )


def test_an_order_with_joints_that_are_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = hrp2.robot()
    with pytest.raises(
        SettingsError,
        match=r"robot\.yaml: columns\.joints names 'thumb', which the URDF lacks \(valid: joints of the "
        r"URDF, in the controller's order\)$",
    ):
        ordered_joints(replace(robot, columns={"joints": [*robot.joint_names, "thumb"]}))
    file = hrp2.write(tmp_path)
    file.write_text(file.read_text() + "columns: {joints: [thumb]}\n")
    line = command_line.refused(
        capsys, "design", file, "--stiffness", 500, "--to", "mc_rtc", "--out", tmp_path / "motion.csv"
    )
    assert "columns.joints names 'thumb'" in line


@pytest.mark.parametrize(("rate", "taken"), [(20.0, True), (2000.0, True), (19.9, False), (2001.0, False)])
def test_a_rate_that_no_controller_has_is_refused(rate: float, taken: bool) -> None:
    if taken:
        check_outputs(hrp2.robot(), rate, ())
    else:
        with pytest.raises(SettingsError, match="20 to 2000 Hz"):
            check_outputs(hrp2.robot(), rate, ())
