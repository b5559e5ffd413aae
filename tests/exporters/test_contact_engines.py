"""Feet on points pushed in Drake, Bullet, PhysX and Newton, in Pythons of their own; a skip says which is missing.

Each program loads the file that a user gets, takes the other foot's points off the ground, presses the robot on one
foot with a share of its weight at the bush centre of the robot file, turns it until it stands, and lets go. What the
angles make of K and C is found here.
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import curve_fit

from export_robots import CENTRE, TRUTH, bush_rotation, result, write_urdf
from plantar.conventions import GRAVITY, Axis
from plantar.exporters import export
from pushed_foot import other_python
from usd_stage import write_usd

WEIGHT = 31.0 * GRAVITY  # of the export tests' biped
STAND, FREE = 6.0, 6.0  # s: the robot's own inertia swings on the foot
TORQUE = 3.0  # N·m: within the angle at which the first point leaves the ground

DRAKE = """
import json, re, sys
import numpy as np
from pydrake.all import *

job = json.load(sys.stdin)
text = re.sub(r'<collision name="%s_contact_.*?</collision>' % job["other"], "", open(job["file"]).read(), flags=re.S)
builder = DiagramBuilder()
plant, _ = AddMultibodyPlantSceneGraph(builder, job["step"])
plant.set_discrete_contact_approximation(getattr(DiscreteContactApproximation, job["kind"]))
plant.set_contact_model(ContactModel.kPoint)
Parser(plant).AddModelsFromString(text, "sdf")
floor = ProximityProperties()
AddContactMaterial(dissipation=0.0, point_stiffness=1e9, friction=CoulombFriction(1, 1), properties=floor)
floor.AddProperty("material", "relaxation_time", 0.0)
plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform([0, 0, job["floor"]]), HalfSpace(), "floor", floor)
plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
plant.Finalize()
diagram = builder.Build()
ankle = plant.GetBodyByName(job["ankle"])
simulator = Simulator(diagram)
context = simulator.get_mutable_context()
mine = plant.GetMyMutableContextFromRoot(context)
port = plant.get_applied_spatial_force_input_port()
start = ankle.EvalPoseInWorld(mine).rotation().matrix()

def push(torque):
    force = ExternallyAppliedSpatialForce()
    force.body_index, force.p_BoBq_B = ankle.index(), np.array(job["centre"])
    force.F_Bq_W = SpatialForce(torque * start @ np.array(job["axis"]), np.array([0, 0, -job["load"]]))
    port.FixValue(mine, [force])

def angle():
    turned = ankle.EvalPoseInWorld(mine).rotation().matrix() @ start.T
    return float(AngleAxis(turned).angle() * (AngleAxis(turned).axis() @ start @ np.array(job["axis"])))

now, track = 0.0, []
for torque, span in ((-job["torque"], job["stand"]), (job["torque"], job["stand"]), (0.0, job["free"])):
    push(torque)
    simulator.Initialize()
    track.append([angle()])
    for _ in range(round(span / job["step"])):
        now += job["step"]
        simulator.AdvanceTo(now)
        track[-1].append(angle())
print("\\n" + json.dumps(track))
"""

BULLET = """
import json, sys
import numpy as np
import pybullet as bullet

job = json.load(sys.stdin)
bullet.connect(bullet.DIRECT)
bullet.setTimeStep(job["step"])
ground = bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE), basePosition=[0, 0, job["floor"]])
bullet.changeDynamics(ground, -1, lateralFriction=1)
robot = bullet.loadURDF(job["file"], flags=bullet.URDF_USE_INERTIA_FROM_FILE)
links = {bullet.getJointInfo(robot, index)[12].decode(): index for index in range(bullet.getNumJoints(robot))}
for name, link in [("", -1), *links.items()]:
    bullet.changeDynamics(robot, link, linearDamping=0, angularDamping=0)
    if name.startswith(job["other"] + "_contact_"):
        bullet.setCollisionFilterPair(robot, ground, link, -1, 0)
ankle = links[job["ankle"]]

def pose():
    state = bullet.getLinkState(robot, ankle, computeForwardKinematics=True)
    return np.array(state[4]), np.array(bullet.getMatrixFromQuaternion(state[5])).reshape(3, 3)

start = pose()[1]
axis = start @ np.array(job["axis"])

def angle():
    turned = pose()[1] @ start.T
    return float(0.5 * axis @ [turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])

track = []
for torque, span in ((-job["torque"], job["stand"]), (job["torque"], job["stand"]), (0.0, job["free"])):
    track.append([angle()])
    for _ in range(round(span / job["step"])):
        place, turn = pose()
        at = (place + turn @ np.array(job["centre"])).tolist()
        bullet.applyExternalForce(robot, ankle, [0, 0, -job["load"]], at, bullet.WORLD_FRAME)
        bullet.applyExternalTorque(robot, ankle, (torque * axis).tolist(), bullet.WORLD_FRAME)
        bullet.stepSimulation()
        track[-1].append(angle())
print("\\n" + json.dumps(track))
"""

PHYSX = """
import json, sys
import numpy as np
import ovphysx, ovstage
from ovphysx.samples.python_samples.schema_support import physx_schema_paths
from ovphysx.types import SimObjectType

job = json.load(sys.stdin)
ovphysx.PhysX.set_cpu_mode(True)
ovstage.population.register_usd_schemas([*map(str, physx_schema_paths()), str(ovphysx.newton_schema_root())])
BODY = SimObjectType.ARTICULATION_LINK
physx = ovphysx.PhysX()
stage = ovstage.Stage("pushed")
ovstage.population.open_usd(stage, job["file"], ordinal=1, domains=ovstage.PopulationDomain.ALL)
stage.advance_write_floor(ordinal=1).wait()
physx.wait_task(physx.attach_ovstage(stage, read_ordinal=1))
physx.wait_all()
query = physx.query(BODY, pattern=job["ankle"]).wait()

def get(name):
    with physx.read(query, [name]).wait() as reading:
        return reading.fetch_next().wait().tensors[0].numpy()[0].astype(float)

def turn():
    x, y, z, w = get("orientation")
    return np.array([[1-2*(y*y+z*z), 2*(x*y-w*z), 2*(x*z+w*y)], [2*(x*y+w*z), 1-2*(x*x+z*z), 2*(y*z-w*x)],
                     [2*(x*z-w*y), 2*(y*z+w*x), 1-2*(x*x+y*y)]])

start = turn()
axis = start @ np.array(job["axis"])

def angle():
    turned = turn() @ start.T
    return float(0.5 * axis @ [turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])

track = []
for torque, span in ((-job["torque"], job["stand"]), (job["torque"], job["stand"]), (0.0, job["free"])):
    track.append([angle()])
    for _ in range(round(span / job["step"])):
        at = get("position") + turn() @ np.array(job["centre"])
        wrench = np.r_[0, 0, -job["load"], torque * axis, at]
        with physx.write_sync(BODY, "wrench", pattern=job["ankle"]) as session:
            for group in session.groups:
                group.tensors[0].assign(wrench[None].astype(np.float32))
                session.commit_sync(group)
        physx.step_sync(job["step"])
        track[-1].append(angle())
print("\\n" + json.dumps(track), flush=True)
"""

# Put down within a second: all at once the foot would hop, for Newton's ground is where the unloaded points stand.
NEWTON = """
import json, sys
import xml.etree.ElementTree as ET
import numpy as np
import warp as wp
wp.config.quiet = True
import newton

job = json.load(sys.stdin)
tree = ET.parse(job["file"])
for body in tree.getroot().iter("body"):
    for geom in body.findall("geom"):
        if geom.get("name", "").startswith(job["other"] + "_contact_"):
            body.remove(geom)
tree.write(job["file"])
builder = newton.ModelBuilder()
newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
builder.add_mjcf(job["file"], enable_self_collisions=False)
builder.add_ground_plane()
model = builder.finalize(device="cpu")
model.set_gravity((0.0, 0.0, 0.0))
solver = newton.solvers.SolverMuJoCo(model, use_mujoco_cpu=True, use_mujoco_contacts=True)
body = [label.split("/")[-1] for label in model.body_label].index(job["ankle"])
now, then, control = model.state(), model.state(), model.control()
newton.eval_fk(model, model.joint_q, model.joint_qd, now)
com = model.body_com.numpy()[body]

def pose():
    found = now.body_q.numpy()[body].astype(float)
    x, y, z, w = found[3:]
    return found[:3], np.array([[1-2*(y*y+z*z), 2*(x*y-w*z), 2*(x*z+w*y)], [2*(x*y+w*z), 1-2*(x*x+z*z), 2*(y*z-w*x)],
                     [2*(x*z-w*y), 2*(y*z+w*x), 1-2*(x*x+y*y)]])

start = pose()[1]
axis = start @ np.array(job["axis"])

def angle():
    turned = pose()[1] @ start.T
    return float(0.5 * axis @ [turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])

track, ramp = [], 0.0
for torque, span in ((-job["torque"], job["stand"]), (job["torque"], job["stand"]), (0.0, job["free"])):
    track.append([angle()])
    for _ in range(round(span / job["step"])):
        ramp = min(1.0, ramp + job["step"])
        force = ramp * np.array([0, 0, -job["load"]])
        arm = pose()[1] @ (np.array(job["centre"]) - com)
        push = np.zeros((model.body_count, 6), np.float32)
        push[body] = np.r_[force, np.cross(arm, force) + ramp * torque * axis]
        now.clear_forces()
        now.body_f.assign(push)
        solver.step(now, then, control, None, job["step"])
        now, then = then, now
        track[-1].append(angle())
print("\\n" + json.dumps(track))
"""


def pushed(
    python: str, program: str, file: Path, foot: str, axis: Axis, share: float, step: float, **more: object
) -> tuple[float, float]:
    """K and C of one foot in an engine, as shares of the truth less one."""
    job = {"file": str(file), "ankle": f"{foot}_ankle", "other": {"left": "right", "right": "left"}[foot],
           "centre": CENTRE.tolist(), "axis": bush_rotation(foot)[:, {"roll": 0, "pitch": 1}[axis]].tolist(),
           "load": share * WEIGHT, "torque": TORQUE, "step": step, "stand": STAND, "free": FREE} | more  # fmt: skip
    done = subprocess.run(
        [python, "-c", program], input=json.dumps(job), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr[-2000:]
    there, back, free = (np.array(track) for track in json.loads(done.stdout.splitlines()[-1]))
    for track in (there, back):
        assert np.ptp(track[-round(0.2 / step) :]) < 0.02 * abs(track[-1]), "it has not come to rest"
    k = 2 * TORQUE / (back[-1] - there[-1])
    wanted = TRUTH[foot][axis]
    c = swinging(free, step, k)
    return k / wanted[0] - 1, c / wanted[1] - 1


def swinging(track: np.ndarray, step: float, k: float) -> float:
    """C from how a robot of unknown inertia I swings free on a known K: A·exp(-σt)·cos(ωt + φ) + rest.

    K/I = σ² + ω² and C/I = 2σ.
    """
    times = step * np.arange(len(track))

    def shape(t: np.ndarray, a: float, b: float, decay: float, swing: float, rest: float) -> np.ndarray:
        return np.exp(-decay * t) * (a * np.cos(swing * t) + b * np.sin(swing * t)) + rest

    rest = float(track[-1])
    first = float(times[np.argmax(track - rest < 0)])  # a quarter of a period, or a little more
    guess = (track[0] - rest, 0.0, 1.0, 0.5 * np.pi / first, rest)
    _, _, decay, swing, _ = curve_fit(shape, times, track, guess)[0]
    return float(2 * decay * k / (decay**2 + swing**2))


def right(found: tuple[float, float], k: float = 0.05, c: float = 0.15) -> None:
    assert abs(found[0]) < k
    assert abs(found[1]) < c


CASES = [("left", "pitch", 0.5), ("right", "pitch", 1.1), ("right", "roll", 0.5), ("right", "roll", 1.1)]


@pytest.mark.parametrize(("foot", "axis", "share"), CASES)
@pytest.mark.parametrize(("kind", "step"), [("kSap", 0.001), ("kSap", 0.004), ("kLagged", 0.001)])
def test_drake_turns_on_points_as_identified(
    tmp_path: Path, foot: str, axis: Axis, share: float, kind: str, step: float
) -> None:
    python = other_python("PLANTAR_DRAKE_PYTHON", "pydrake")
    export(
        result(write_urdf(tmp_path / "biped.urdf", rigid_legs=True)), "drake-contact", tmp_path / "out.sdf"
    )
    found = pushed(python, DRAKE, tmp_path / "out.sdf", foot, axis, share, step, kind=kind, floor=-0.51)
    # Hunt and Crossley's damping grows with what a point carries: it is written for a robot on two feet.
    right(found, c=0.15 if kind == "kSap" or share == 0.5 else 0.3)


@pytest.mark.parametrize(("foot", "axis", "share"), CASES)
@pytest.mark.parametrize("step", [0.001, 0.004])
def test_bullet_turns_on_points_as_identified(
    tmp_path: Path, foot: str, axis: Axis, share: float, step: float
) -> None:
    python = other_python("PLANTAR_BULLET_PYTHON", "pybullet")
    out = tmp_path / "out.urdf"
    export(result(write_urdf(tmp_path / "biped.urdf", rigid_legs=True)), "bullet-contact", out)
    right(pushed(python, BULLET, out, foot, axis, share, step, floor=-0.51))


@pytest.mark.parametrize(("foot", "axis", "share"), CASES)
@pytest.mark.parametrize(("solver", "k"), [("PGS", 0.05), ("TGS", 0.08)])
def test_physx_turns_on_points_as_identified(
    tmp_path: Path, foot: str, axis: Axis, share: float, solver: str, k: float
) -> None:
    """TGS takes 5 to 6 % off K whatever the step and its iterations; PGS does not."""
    python = other_python("PLANTAR_PHYSX_PYTHON", "ovphysx")
    out = physx_file(tmp_path, foot, solver)
    right(pushed(python, PHYSX, out, foot, axis, share, 0.004, ankle=f"/World/biped/{foot}_ankle"), k)


@pytest.mark.parametrize(("foot", "axis", "share"), CASES)
@pytest.mark.parametrize("step", [0.001, 0.004])
def test_newton_turns_on_the_points_of_mujoco_as_identified(
    tmp_path: Path, foot: str, axis: Axis, share: float, step: float
) -> None:
    """Newton hands `solref` and `solimp` on to MuJoCo where its builder was told to keep them."""
    python = other_python("PLANTAR_NEWTON_PYTHON", "newton")
    out = tmp_path / "out.xml"
    export(result(write_urdf(tmp_path / "biped.urdf", rigid_legs=True)), "mujoco-contact", out)
    right(pushed(python, NEWTON, out, foot, axis, share, step), k=0.02, c=0.01)


def physx_file(folder: Path, foot: str, solver: str) -> Path:
    """The exported layer on a stage whose robot is let go, on a ground, with the other foot's points off."""
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics

    urdf, out = write_urdf(folder / "biped.urdf"), folder / "out.usda"
    export(result(urdf), "physx-contact", out, model=write_usd(folder / "stage.usda"))
    stage = Usd.Stage.Open(str(out))
    scene = stage.GetPrimAtPath("/scene")
    scene.AddAppliedSchema("PhysxSceneAPI")
    scene.CreateAttribute("physxScene:solverType", Sdf.ValueTypeNames.Token).Set(solver)
    stage.GetPrimAtPath("/World/biped/held").SetActive(False)
    for prim in stage.Traverse():
        if prim.IsA(UsdGeom.Sphere) and not prim.GetName().startswith(foot):
            UsdPhysics.CollisionAPI(prim).CreateCollisionEnabledAttr(False)
    ground = UsdGeom.Plane.Define(stage, "/World/ground")
    ground.CreateAxisAttr("Z")
    UsdGeom.Xformable(ground).AddTranslateOp().Set(Gf.Vec3d(0, 0, -0.01))
    UsdPhysics.CollisionAPI.Apply(ground.GetPrim())
    stage.GetRootLayer().Save()
    return out
