"""Exports pushed in engines that live in Pythons of their own; a skip says which one is missing.

Each program loads the file as its users do, holds the robot, pushes one sole at a time until it stands, lets go, and
prints where ankle and sole were; what that makes of K and C is found here.
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from export_robots import TRUTH, bush_rotation, result, write_urdf
from plantar.conventions import rotation_from_rpy
from plantar.exporters import export
from pushed_foot import DIRECTION, LOAD, deflection, measured, other_python
from usd_stage import write_usd

SETTLE, FREE = 0.6, 0.4  # s

NEWTON = """
import json, sys
import numpy as np
import warp as wp
wp.config.quiet = True
import newton

job = json.load(sys.stdin)
builder = newton.ModelBuilder()
(builder.add_usd if job["file"].endswith(".usda") else builder.add_mjcf)(job["file"], enable_self_collisions=False)
builder.joint_armature = [1e9 if dof < job["held"] else one for dof, one in enumerate(builder.joint_armature)]
model = builder.finalize(device="cpu")
model.set_gravity((0.0, 0.0, 0.0))
place = {label.split("/")[-1]: index for index, label in enumerate(model.body_label)}
answers = []
for load in job["loads"]:
    solver = newton.solvers.SolverMuJoCo(model, use_mujoco_cpu=True, disable_contacts=True)
    now, then, control = model.state(), model.state(), model.control()
    newton.eval_fk(model, model.joint_q, model.joint_qd, now)
    ends = [place[load["ankle"]], place[load["sole"]]]
    push = np.zeros((model.body_count, 6), np.float32)
    push[ends[1], (0 if load["axis"] == "z" else 3):][:3] = load["vector"]
    poses = [now.body_q.numpy()[ends].tolist()]
    for count in range(job["settle"] + job["free"]):
        now.clear_forces()
        if count < job["settle"]:
            now.body_f.assign(push)
        solver.step(now, then, control, None, job["step"])
        now, then = then, now
        if count >= job["settle"] - 1:
            poses.append(now.body_q.numpy()[ends].tolist())
    answers.append(poses)
print("\\n" + json.dumps(answers))
"""

GENESIS = """
import json, sys
import numpy as np
import genesis as gs

job = json.load(sys.stdin)
gs.init(backend=gs.cpu, precision="64", logging_level="error")
scene = gs.Scene(
    sim_options=gs.options.SimOptions(dt=job["step"], gravity=(0, 0, 0)),
    rigid_options=gs.options.RigidOptions(enable_collision=False), show_viewer=False)
robot = scene.add_entity(gs.morphs.MJCF(file=job["file"]))
scene.build()
held = robot.get_dofs_armature()
held[: job["held"]] = 1e9
robot.set_dofs_armature(held)
answers = []
for load in job["loads"]:
    scene.reset()
    ends = [robot.get_link(load[name]) for name in ("ankle", "sole")]

    def pose():
        found = [(one.get_pos().numpy().ravel(), one.get_quat().numpy().ravel()) for one in ends]
        return [[*place.tolist(), *turn[[1, 2, 3, 0]].tolist()] for place, turn in found]

    poses = [pose()]
    for count in range(job["settle"] + job["free"]):
        if count < job["settle"]:
            apply = ends[1].apply_external_force if load["axis"] == "z" else ends[1].apply_external_torque
            apply(np.array(load["vector"]))
        scene.step()
        if count >= job["settle"] - 1:
            poses.append(pose())
    answers.append(poses)
print("\\n" + json.dumps(answers))
"""

# Bullet reads dampers of a URDF and no springs: those of Gazebo's tags are applied before each step, as a user would.
BULLET = """
import json, sys
import xml.etree.ElementTree as ET
import pybullet as bullet

job = json.load(sys.stdin)
bullet.connect(bullet.DIRECT)
bullet.setGravity(0, 0, 0)
bullet.setTimeStep(job["step"])
robot = bullet.loadURDF(job["file"], useFixedBase=True, flags=bullet.URDF_USE_INERTIA_FROM_FILE)
infos = [bullet.getJointInfo(robot, index) for index in range(bullet.getNumJoints(robot))]
joints, links = ({info[key].decode(): info[0] for info in infos} for key in (1, 12))
springs = {joints[tag.get("reference")]: float(tag.findtext("springStiffness"))
           for tag in ET.parse(job["file"]).getroot().findall("gazebo") if tag.findtext("springStiffness")}
for index in joints.values():
    bullet.changeDynamics(robot, index, linearDamping=0, angularDamping=0)
answers = []
for load in job["loads"]:
    for joint in springs:
        bullet.resetJointState(robot, joint, 0)
        bullet.setJointMotorControl2(robot, joint, bullet.VELOCITY_CONTROL, force=0)
    ends = [links[load[name]] for name in ("ankle", "sole")]

    def pose():
        found = [bullet.getLinkState(robot, one, computeForwardKinematics=True) for one in ends]
        return [[*one[4], *one[5]] for one in found]

    poses = [pose()]
    for count in range(job["settle"] + job["free"]):
        for joint, stiffness in springs.items():
            torque = -stiffness * bullet.getJointState(robot, joint)[0]
            bullet.setJointMotorControl2(robot, joint, bullet.TORQUE_CONTROL, force=torque)
        if count < job["settle"]:
            if load["axis"] == "z":
                at = bullet.getLinkState(robot, ends[1], computeForwardKinematics=True)[0]
                bullet.applyExternalForce(robot, ends[1], load["vector"], at, bullet.WORLD_FRAME)
            else:
                bullet.applyExternalTorque(robot, ends[1], load["vector"], bullet.WORLD_FRAME)
        bullet.stepSimulation()
        if count >= job["settle"] - 1:
            poses.append(pose())
    answers.append(poses)
print("\\n" + json.dumps(answers))
"""


def pushed(
    python: str, program: str, file: Path, step: float, held: int, turn: np.ndarray, damping: float
) -> None:
    """Push every axis of every foot of a robot that is turned by `turn`: K within 1 %, C within `damping`.

    These engines damp implicitly and spring explicitly, which takes K·step/2 off C: that is put back.
    """
    cases = [(foot, axis) for foot, axes in TRUTH.items() for axis in axes]
    loads = [{"axis": axis, "sole": f"{foot}_bush_sole", "ankle": f"{foot}_ankle",
              "vector": (LOAD[axis] * (turn @ bush_rotation(foot))[:, DIRECTION[axis]]).tolist()}
             for foot, axis in cases]  # fmt: skip
    job = {"file": str(file), "loads": loads, "step": step, "held": held,
           "settle": round(SETTLE / step), "free": round(FREE / step)}  # fmt: skip
    done = subprocess.run(
        [python, "-c", program], input=json.dumps(job), capture_output=True, text=True, timeout=900
    )
    assert done.returncode == 0, done.stderr[-2000:]
    for (foot, axis), poses in zip(cases, json.loads(done.stdout.splitlines()[-1]), strict=True):
        track = np.array([deflection(axis, bush_rotation(foot), *np.array(pair)) for pair in poses])
        rest, track = track[0], track[1:] - track[0]
        assert abs(rest) < 1 if axis == "z" else abs(rest) < 1e-6
        k, c = measured(LOAD[axis], track, step)
        assert k == pytest.approx(TRUTH[foot][axis][0], rel=0.01)
        assert c + k * step / 2 == pytest.approx(TRUTH[foot][axis][1], rel=damping)


@pytest.mark.parametrize("kind", ["mjcf", "usd"])
def test_newton_gives_stiffness_and_damping_back(kind: str, tmp_path: Path) -> None:
    python = other_python("PLANTAR_NEWTON_PYTHON", "newton")
    urdf = write_urdf(tmp_path / "biped.urdf", rigid_legs=True)
    out = tmp_path / ("out.xml" if kind == "mjcf" else "out.usda")
    if kind == "mjcf":
        export(result(urdf), kind, out)
        pushed(python, NEWTON, out, 1e-3, 6, np.eye(3), 0.005)
    else:
        export(result(urdf), kind, out, model=write_usd(tmp_path / "stage.usda"))
        pushed(python, NEWTON, out, 1e-3, 0, rotation_from_rpy(np.array([0.0, 0.0, 0.4])), 0.005)


def test_genesis_gives_stiffness_and_damping_back(tmp_path: Path) -> None:
    python = other_python("PLANTAR_GENESIS_PYTHON", "genesis")
    export(result(write_urdf(tmp_path / "biped.urdf", rigid_legs=True)), "mjcf", tmp_path / "out.xml")
    pushed(python, GENESIS, tmp_path / "out.xml", 1e-3, 6, np.eye(3), 0.04)


def test_bullet_gives_stiffness_and_damping_back(tmp_path: Path) -> None:
    python = other_python("PLANTAR_BULLET_PYTHON", "pybullet")
    export(result(write_urdf(tmp_path / "biped.urdf", rigid_legs=True)), "urdf", tmp_path / "out.urdf")
    pushed(python, BULLET, tmp_path / "out.urdf", 1e-4, 0, np.eye(3), 0.06)
