"""`plantar convert` and `plantar init`, and a newcomer's way from a bag and a URDF to a MuJoCo model."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import yaml

from biped import TRUTH, record, sway
from biped_robot import Frame, Mounting, make_robot, write_robot
from example_robots import G1, ICUB, TALOS
from log_formats import write_hrpsys, write_mcap
from plantar.cli import main
from plantar.exporters.urdf.tree import UrdfTree
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.readers.column_map import apply, joint_order, ports
from plantar.logs.save import save_log
from plantar.robot.model import load_robot
from plantar.robot_guess.biped import find_biped
from plantar.robot_guess.feet import find_sole


def command(*words: object) -> int:
    with pytest.raises(SystemExit) as done:
        main([str(word) for word in words])
    return int(done.value.code or 0)


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway("sway", duration=2.0))


def test_convert_to_every_format_and_back(
    log: MotionLog, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag, _ = write_mcap(log, tmp_path)
    robot = write_robot(tmp_path / "robot")
    for ending in ("parquet", "csv", "mcap"):
        out = tmp_path / f"sway.{ending}"
        assert command("convert", bag, "--robot", robot, "--out", out) == 0
        again = open_log(out, load_robot(robot))
        assert set(again.columns) == set(log.columns)
        np.testing.assert_allclose(again.column("wrench.left.torque.x"), log.column("wrench.left.torque.x"))
    assert "imu 'chest' is taken from /sensors/torso/imu" in capsys.readouterr().err


def test_convert_several_logs_into_a_directory(
    log: MotionLog, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("one", "two"):
        save_log(log, tmp_path / f"{name}.csv")
    logs = [tmp_path / "one.csv", tmp_path / "two.csv"]
    assert command("convert", *logs, "--out", tmp_path / "all", "--to", "mcap") == 0
    assert sorted(path.name for path in (tmp_path / "all").iterdir()) == ["one.mcap", "two.mcap"]
    assert command("convert", *logs, "--out", tmp_path / "usual") == 0
    assert sorted(path.name for path in (tmp_path / "usual").iterdir()) == ["one.parquet", "two.parquet"]
    assert command("convert", *logs, "--out", tmp_path / "all.csv") == 1
    assert command("convert", logs[0], logs[0], "--out", tmp_path / "all") == 1
    assert command("convert", logs[0], "--out", tmp_path / "log.xlsx") == 1
    assert not (tmp_path / "log.xlsx").exists(), "no folder in the place of a file"
    assert command("convert", logs[0], "--out", tmp_path / "of_2026.11") == 0  # a directory of that name
    assert command("convert", *logs, "--out", tmp_path / "all", "--to", "xlsx") == 1
    assert "csv, parquet, mcap" in capsys.readouterr().err


def test_convert_reads_the_robots_column_map(log: MotionLog, tmp_path: Path) -> None:
    port, columns = write_hrpsys(log, tmp_path)
    robot = write_robot(tmp_path / "robot", columns=columns)
    assert command("convert", port, "--robot", robot, "--out", tmp_path / "walk.parquet", "--quiet") == 0
    again = open_log(tmp_path / "walk.parquet")
    np.testing.assert_allclose(
        again.column("joint.neck.position"), log.column("joint.neck.position"), atol=1e-12
    )


def test_init_marks_every_guess_and_does_not_write_over(log: MotionLog, tmp_path: Path) -> None:
    write_robot(tmp_path)
    (tmp_path / "robot.yaml").unlink()
    save_log(log, tmp_path / "sway.mcap", make_robot(tmp_path / "known"))
    out = tmp_path / "robot.yaml"
    assert command("init", tmp_path / "biped.urdf", tmp_path / "sway.mcap", "--out", out) == 0
    text = out.read_text()
    data = yaml.safe_load(text)
    assert data["feet"]["left"]["ankle"] == "left_foot"
    assert data["feet"]["right"]["wrench"]["name"] == "right"
    assert data["imu"]["name"] == "chest"
    assert data["topics"]["left"] == "/wrench/left"
    for line in text.splitlines():
        if "bush:" in line:
            assert "GUESS" in line
    assert command("init", tmp_path / "biped.urdf", tmp_path / "sway.mcap", "--out", out) == 1
    assert command("init", tmp_path / "biped.urdf", tmp_path / "sway.mcap", "--out", out, "--force") == 0


def test_init_sees_a_sensor_that_reads_the_other_way(log: MotionLog, tmp_path: Path) -> None:
    write_robot(tmp_path)
    columns = {
        name: -values if name.startswith("wrench.left.") else values for name, values in log.columns.items()
    }
    save_log(MotionLog("sway", log.time, columns), tmp_path / "sway.csv")
    assert command("init", tmp_path / "biped.urdf", tmp_path / "sway.csv", "--out", tmp_path / "r.yaml") == 0
    feet = yaml.safe_load((tmp_path / "r.yaml").read_text())["feet"]
    assert feet["left"]["wrench"]["sign"] == -1
    assert "sign" not in feet["right"]["wrench"]


@pytest.mark.parametrize(
    ("urdf", "ankles", "depth"),
    [
        (TALOS, {"left": "leg_left_6_link", "right": "leg_right_6_link"}, -0.107),
        (G1, {"left": "left_ankle_roll_link", "right": "right_ankle_roll_link"}, -0.035),
        (ICUB, {"left": "l_ankle_2", "right": "r_ankle_2"}, None),
    ],
)
def test_feet_of_real_robots_are_found(urdf: Path, ankles: dict[str, str], depth: float | None) -> None:
    tree, model = UrdfTree.load(urdf), pin.buildModelFromXML(urdf.read_text())
    biped = find_biped(tree, model)
    assert {leg.side: leg.link for leg in biped.legs} == ankles
    for leg in biped.legs:
        sole = find_sole(tree, model, biped, leg)
        length, width = np.ptp(sole.corners, axis=0)
        assert 0.05 < width < length < 0.35
        assert sole.corners[:, 0].max() > -sole.corners[:, 0].min() or urdf == TALOS, "toes are in front"
        assert depth is None or sole.depth == pytest.approx(depth, abs=1e-3)


@pytest.mark.slow
def test_a_newcomer_gets_from_a_bag_and_a_urdf_to_mujoco_in_four_commands(tmp_path: Path) -> None:
    """init, two lines by hand, inspect, identify, export: the MuJoCo model has the bushes' true numbers."""
    mujoco = pytest.importorskip("mujoco")
    mounting = Mounting(wrench=Frame())  # sensors at a link of the URDF, as drivers say in their messages
    write_robot(tmp_path, mounting)
    known = make_robot(tmp_path / "known", mounting)
    (tmp_path / "robot.yaml").unlink()
    bag, robot, result = tmp_path / "sway.mcap", tmp_path / "robot.yaml", tmp_path / "out" / "result.json"
    save_log(record(sway("sway", duration=20.0), mounting), bag, known)

    assert command("init", tmp_path / "biped.urdf", bag, "--out", robot) == 0
    lines = robot.read_text().splitlines()
    by_hand = [index for index, line in enumerate(lines) if "    bush:" in line]
    assert len(by_hand) <= 3
    for index in by_hand:  # what no URDF knows
        lines[index] = "    bush: {xyz: [0, 0, -0.06]}"
    robot.write_text("\n".join(lines))
    assert command("inspect", robot, bag, "--quiet") == 0
    assert command("identify", "feet", robot, bag, "--out", tmp_path / "out", "--quiet") == 0
    assert command("export", result, "--to", "mjcf", "--out", tmp_path / "feet.xml") == 0

    model = mujoco.MjModel.from_xml_path(str(tmp_path / "feet.xml"))
    for (foot, axis), law in TRUTH.items():
        joint = model.joint(f"{'L' if foot == 'left' else 'R'}LEG_BUSH_{axis.upper()}")
        assert joint.stiffness[0] == pytest.approx(law.stiffness, rel=0.01)
        assert model.dof_damping[joint.dofadr[0]] == pytest.approx(law.damping, rel=0.01)


def test_the_snippets_of_the_documentation_are_robot_files(tmp_path: Path) -> None:
    text = (Path(__file__).resolve().parents[2] / "docs" / "formats.md").read_text()
    snippets = [yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)]
    assert len(snippets) >= 3
    for number, snippet in enumerate(snippets):
        robot = make_robot(tmp_path / str(number), **snippet)
        assert joint_order(robot) is None or len(joint_order(robot) or ()) > 1
        assert all(roles for roles in ports(robot).values())
    table = dict.fromkeys(
        [
            "stamp",
            "hip_angle",
            "hip_speed",
            "qx",
            "qy",
            "qz",
            "qw",
            "ax",
            "ay",
            "az",
            "mx",
            "my",
            "mz",
            "f1",
            "f2",
            "f3",
        ],
        np.arange(3.0),
    )
    mapped = next(make_robot(tmp_path / "map", **s) for s in snippets if "time" in s.get("columns", {}))
    time, columns = apply(table, mapped, Path("log.csv"))
    assert time[1] == 1e-3
    assert columns["wrench.left.torque.x"][1] == -1e-3
    for quantity in ("position", "velocity"):
        assert columns[f"joint.hip.{quantity}"][1] == pytest.approx(np.pi / 180)


TALOS_LAW = {
    "left": ((940.0, 31.0), (720.0, 26.0)),
    "right": ((980.0, 35.0), (680.0, 22.0)),
}  # pitch, roll: K, C


def talos_log() -> MotionLog:
    """TALOS sways over its feet, both legs alike, the torso level: exact by Pinocchio's kinematics and the law."""
    model = pin.buildModelFromXML(TALOS.read_text())
    data, imu = model.createData(), model.getFrameId("imu_link")
    time = np.arange(0, 20, 0.005)
    fore, side = (0.05 * np.sin(2 * np.pi * f * time + p) for f, p in ((0.3, 0.0), (0.2, 1.0)))
    bend = [0.02 * np.sin(2 * np.pi * f * time + p) for f, p in ((0.5, 0.3), (0.37, 2.0))]
    angles = {2: -side, 3: -0.4 - fore, 4: 0.8 + 0 * fore, 5: -0.4 + fore + bend[0], 6: side + bend[1]}
    columns: dict[str, np.ndarray] = {}
    q = np.tile(pin.neutral(model), (time.size, 1))
    for name in list(model.names)[1:]:
        number = name.split("_")[2] if name.startswith("leg_") else ""
        values = angles.get(int(number), 0 * time) if number else 0 * time
        columns[f"joint.{name}.position"] = q[:, model.joints[model.getJointId(name)].idx_q] = values
    rotations = {side: np.empty((time.size, 3, 3)) for side in TALOS_LAW}
    for row in range(time.size):
        pin.framesForwardKinematics(model, data, q[row])
        for foot in TALOS_LAW:
            rotations[foot][row] = data.oMf[model.getFrameId(f"leg_{foot}_6_link")].rotation
    w, x, y, z = np.roll(pin.Quaternion(data.oMf[imu].rotation).coeffs(), 1)
    columns |= {
        f"imu.base.orientation.{axis}": np.full(time.size, v)
        for axis, v in zip("wxyz", (w, x, y, z), strict=True)
    }
    up = data.oMf[imu].rotation.T @ [0, 0, 9.80665]
    columns |= {f"imu.base.angular_velocity.{axis}": 0 * time for axis in "xyz"}
    columns |= {
        f"imu.base.linear_acceleration.{axis}": np.full(time.size, v)
        for axis, v in zip("xyz", up, strict=True)
    }
    for foot, laws in TALOS_LAW.items():
        n = rotations[foot][:, 2, :]  # the world's up in the ankle link
        bent = [np.arctan2(n[:, 0], n[:, 2]), -np.arcsin(n[:, 1])]
        pitch, roll = (
            k * b + c * np.gradient(b, time, edge_order=2) for (k, c), b in zip(laws, bent, strict=True)
        )
        axis = np.column_stack([np.cos(bent[0]), 0 * time, -np.sin(bent[0])])
        force = 450.0 * n
        torque = np.outer(pitch, [0, 1, 0]) + roll[:, None] * axis + np.cross([0, 0, -0.08], force)
        for kind, values in (("force", force), ("torque", torque)):
            columns |= {f"wrench.{foot}.{kind}.{a}": values[:, i] for i, a in enumerate("xyz")}
    return MotionLog("sway", time, columns)


@pytest.mark.slow
def test_talos_straight_from_mcap_with_two_lines_by_hand(tmp_path: Path) -> None:
    urdf = tmp_path / "talos.urdf"
    urdf.write_text(TALOS.read_text())
    outline = [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1]]
    feet = {
        foot: {
            "ankle": f"leg_{foot}_6_link",
            "bush": {},
            "wrench": {"name": foot},
            "sole": {"xyz": [0, 0, -0.107], "polygon": outline},
        }
        for foot in TALOS_LAW
    }
    known = {"name": "talos", "urdf": "talos.urdf", "imu": {"name": "base", "link": "imu_link"}, "feet": feet}
    (tmp_path / "known.yaml").write_text(json.dumps(known))
    save_log(talos_log(), tmp_path / "sway.mcap", load_robot(tmp_path / "known.yaml"))
    robot = tmp_path / "robot.yaml"
    assert command("init", urdf, tmp_path / "sway.mcap", "--out", robot) == 0
    lines = [
        "    bush: {xyz: [0, 0, -0.08]}" if "    bush:" in line else line
        for line in robot.read_text().splitlines()
    ]
    robot.write_text("\n".join(lines))
    assert load_robot(robot).imu.placement.link == "imu_link"  # type: ignore[union-attr]
    assert (
        command("identify", "feet", robot, tmp_path / "sway.mcap", "--out", tmp_path / "out", "--quiet") == 0
    )
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    found = {(p["foot"], p["axis"], p["name"]): p["value"] for p in result["parameters"]}
    for foot, laws in TALOS_LAW.items():
        for axis, (stiffness, damping) in zip(("pitch", "roll"), laws, strict=True):
            assert found[foot, axis, "stiffness"] == pytest.approx(stiffness, rel=0.01)
            assert found[foot, axis, "damping"] == pytest.approx(damping, rel=0.02)
