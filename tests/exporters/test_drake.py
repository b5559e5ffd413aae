"""Exports proven in Drake, where a Python has it: a known load on the foot gives K and C back."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from example_robots import TALOS
from export_robots import TRUTH, bush_rotation, result, write_sdf, write_urdf
from plantar.exporters import export
from pushed_foot import DIRECTION, LOAD, check, joint_name

DRAKE_PROGRAM = """
import json, sys
import numpy as np
from pydrake.all import (AddMultibodyPlantSceneGraph, ApplySimulatorConfig, DiagramBuilder,
                         ExternallyAppliedSpatialForce, Parser, Simulator, SimulatorConfig, SpatialForce)

job = json.load(sys.stdin)
builder = DiagramBuilder()
plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
Parser(plant).AddModels(job["file"])
plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("pelvis"))
plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
plant.Finalize()
diagram = builder.Build()
answers = []
for load in job["loads"]:
    simulator = Simulator(diagram)
    context = simulator.get_mutable_context()
    mine = plant.GetMyMutableContextFromRoot(context)
    joint = plant.GetJointByName(load["joint"])
    sole = plant.GetBodyByName(load["sole"])
    ankle = plant.GetBodyByName(load["ankle"])
    turn = ankle.EvalPoseInWorld(mine).rotation().matrix() @ np.array(load["bush"])
    force = ExternallyAppliedSpatialForce()
    force.body_index = sole.index()
    force.p_BoBq_B = np.zeros(3)
    vector = load["load"] * turn[:, load["direction"]]
    force.F_Bq_W = SpatialForce(*((vector, np.zeros(3)) if load["direction"] < 2 else (np.zeros(3), vector)))
    port = plant.get_applied_spatial_force_input_port()
    port.FixValue(mine, [force])
    ApplySimulatorConfig(SimulatorConfig(integration_scheme="radau3", max_step_size=5e-3, accuracy=1e-5), simulator)
    simulator.Initialize()
    slow = load["direction"] < 2
    start, step = (0.9, 5e-3) if slow else (0.15, 1e-3)
    simulator.AdvanceTo(start)
    settled = float(plant.GetPositions(mine)[joint.position_start()])
    port.FixValue(mine, [])
    simulator.Initialize()
    times, decay = [], []
    for count in range(150):
        simulator.AdvanceTo(start + count * step)
        times.append(count * step)
        decay.append(float(plant.GetPositions(mine)[joint.position_start()]))
    answers.append({"settled": settled, "times": times, "decay": decay})
json.dump(answers, sys.stdout)
"""


@pytest.fixture(scope="session")
def drake_python() -> str:
    """A Python that has pydrake: this one, or the one that PLANTAR_DRAKE_PYTHON names."""
    for python in (os.environ.get("PLANTAR_DRAKE_PYTHON"), sys.executable):
        found = python and shutil.which(python)
        if found and subprocess.run([found, "-c", "import pydrake"], capture_output=True).returncode == 0:
            return found
    pytest.skip("no pydrake: pip install drake, or name a Python that has it in PLANTAR_DRAKE_PYTHON")


@pytest.mark.parametrize(
    ("target", "source"), [("sdf", "1.9"), ("sdf", "urdf"), ("drake", "1.9"), ("drake", "urdf")]
)
def test_drake_gives_stiffness_and_damping_back(
    target: str, source: str, tmp_path: Path, drake_python: str
) -> None:
    urdf = write_urdf(tmp_path / "rigid.urdf", rigid_legs=True)
    model = urdf if source == "urdf" else write_sdf(tmp_path / "robot.sdf", source)
    out = tmp_path / "out.sdf"
    export(result(urdf), target, out, model=model)
    cases = [(foot, axis) for foot, axes in TRUTH.items() for axis in axes]
    loads = [{"joint": joint_name(foot, axis), "sole": f"{foot}_bush_sole", "ankle": f"{foot}_ankle",
              "bush": bush_rotation(foot).tolist(), "direction": DIRECTION[axis], "load": LOAD[axis]}
             for foot, axis in cases]  # fmt: skip
    job = json.dumps({"file": str(out), "loads": loads})
    done = subprocess.run(
        [drake_python, "-c", DRAKE_PROGRAM], input=job, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr[-2000:]
    for (foot, axis), answer in zip(cases, json.loads(done.stdout), strict=True):
        check(foot, axis, LOAD[axis], answer["settled"], np.array(answer["times"]), np.array(answer["decay"]))


def test_talos_loads_in_drake_and_weighs_what_it_did(tmp_path: Path, drake_python: str) -> None:
    made = result(TALOS, "talos")
    for foot, entry in made["robot_model"]["feet"].items():
        entry["ankle"] = entry["bush"]["link"] = f"leg_{foot}_6_link"
        entry["sole"]["link"] = f"{foot}_sole_link"
    export(made, "drake", tmp_path / "talos.sdf")
    program = """
import sys
from pydrake.all import AddMultibodyPlantSceneGraph, DiagramBuilder, Parser
builder = DiagramBuilder()
plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
Parser(plant).AddModels(sys.argv[1])
plant.Finalize()
print(plant.CalcTotalMass(plant.CreateDefaultContext()))
print(len(plant.GetCollisionGeometriesForBody(plant.GetBodyByName("left_bush_sole"))))
"""
    done = subprocess.run(
        [drake_python, "-c", program, tmp_path / "talos.sdf"], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr[-2000:]
    mass, shapes = done.stdout.split()
    model = pin.buildModelFromXML(TALOS.read_text(), pin.JointModelFreeFlyer())
    assert float(mass) == pytest.approx(pin.computeTotalMass(model), abs=1e-6)
    assert int(shapes) == 1
