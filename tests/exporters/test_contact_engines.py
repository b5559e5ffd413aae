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
from programs_on_points import BULLET, DRAKE, NEWTON, PHYSX
from pushed_foot import other_python
from usd_stage import write_usd

WEIGHT = 31.0 * GRAVITY  # of the export tests' biped
STAND, FREE = 6.0, 6.0  # s: the robot's own inertia swings on the foot
TORQUE = 3.0  # N·m: within the angle at which the first point leaves the ground


def pushed(
    python: str, program: str, file: Path, foot: str, axis: Axis, share: float, step: float, **more: object
) -> tuple[float, float]:
    """K and C of one foot in an engine, as shares of the truth less one."""
    job = {"file": str(file), "ankle": f"{foot}_ankle", "other": {"left": "right", "right": "left"}[foot],
           "centre": CENTRE.tolist(), "axis": bush_rotation(foot)[:, {"roll": 0, "pitch": 1}[axis]].tolist(),
           "load": share * WEIGHT, "torque": TORQUE, "step": step, "stand": STAND, "free": FREE} | more  # fmt: skip
    done = subprocess.run(
        [python, "-c", program], input=json.dumps(job), capture_output=True, text=True, timeout=900
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
