"""Programs that push an exported foot on points in an engine, each for a Python that has that engine.

They read a job as JSON: the file, the ankle, the other foot whose points are taken off the ground, load, torque. What
they print is the angle after each step [rad]: turned one way, turned the other way, let go.
"""

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
