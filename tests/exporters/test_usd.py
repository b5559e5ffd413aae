"""The USD layer and the overs on a user's stage: by USD's own validators, and pushed in PhysX where a Python has it."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from command_line import run
from export_robots import CENTRE, TRUTH, bush_rotation, result, write_urdf
from plantar.exporters import export
from plantar.exporters.usd.stage import standing_shapes
from pushed_foot import DIRECTION, LOAD, check, joint_name, other_python
from usd_stage import write_usd

pxr = pytest.importorskip("pxr", reason="no usd-core: pip install 'plantar[usd]'")

KINDS = ("layer", "over")


def written(kind: str, folder: Path) -> Path:
    urdf = write_urdf(folder / "biped.urdf")
    model = write_usd(folder / "stage.usda") if kind == "over" else None
    (folder / "elsewhere").mkdir()
    out = folder / "elsewhere" / "out.usda"
    export(result(urdf), "usd", out, model=model)
    return out


def stage_of(path: Path) -> Any:
    from pxr import Usd

    return Usd.Stage.Open(str(path))


@pytest.mark.parametrize("kind", KINDS)
def test_the_validators_of_usd_find_nothing(kind: str, tmp_path: Path) -> None:
    validation = pytest.importorskip("pxr.UsdValidation", reason="this usd-core has no validators")
    stage = stage_of(written(kind, tmp_path))
    assert not stage.GetCompositionErrors()
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    found = validation.ValidationContext(validators).Validate(stage)
    assert not [one.GetErrorAsString() for one in found]


@pytest.mark.parametrize(
    ("place", "height", "stands"),
    [(0.0, 0.2, True), (0.0, 0.1, False), (-0.1, 0.02, True), (0.1, 0.02, False), (0.1, 0.41, True)],
)
def test_shapes_that_reach_the_sole_are_those_that_stand(place: float, height: float, stands: bool) -> None:
    """The sole 0.1 m below the ankle, the bush 0.04 m above it: what comes within 0.02 m, wherever its middle is."""
    from pxr import Gf, Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.CreateInMemory()
    ankle = UsdGeom.Xform.Define(stage, "/ankle")
    ankle.AddTranslateOp().Set(Gf.Vec3d(3.0, -2.0, 5.0))
    shape = UsdGeom.Cube.Define(stage, "/ankle/shape")
    shape.CreateSizeAttr(1.0)
    shape.AddTranslateOp().Set(Gf.Vec3d(0.05, 0.0, place))
    shape.AddScaleOp().Set(Gf.Vec3f(0.2, 0.1, height))
    foot = SimpleNamespace(centre=np.array([0.0, 0.0, -0.06]), rotation=np.eye(3), sole_depth=0.04)
    assert standing_shapes(ankle.GetPrim(), foot) == []  # type: ignore[arg-type]
    UsdPhysics.CollisionAPI.Apply(shape.GetPrim())
    assert bool(standing_shapes(ankle.GetPrim(), foot)) is stands  # type: ignore[arg-type]


def test_a_foots_name_need_be_no_name_of_usd(tmp_path: Path) -> None:
    made = result(write_urdf(tmp_path / "biped.urdf"))
    made["robot_model"]["feet"]["left-foot 1"] = made["robot_model"]["feet"].pop("left")
    for row in (*made["parameters"], *made["offsets"]):
        row["foot"] = "left-foot 1" if row["foot"] == "left" else row["foot"]
    export(made, "usd", tmp_path / "out.usda")
    stage = stage_of(tmp_path / "out.usda")
    names = {prim.GetName() for prim in stage.Traverse()}
    assert {"left_foot_1", "left_foot_1_bush_pitch"} <= names


def test_a_plate_touches_the_ground_below_all_joints_of_its_bush(tmp_path: Path) -> None:
    from pxr import UsdPhysics

    stage = stage_of(written("layer", tmp_path))
    plates = {str(prim.GetPath()) for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.CollisionAPI)}
    assert plates == {f"/feet/{foot}/{foot}_bush_sole/plate" for foot in TRUTH}


def test_overs_leave_the_users_stage_as_it_is(tmp_path: Path) -> None:
    from pxr import UsdPhysics

    stage = stage_of(written("over", tmp_path))
    assert stage.GetRootLayer().subLayerPaths == ["../stage.usda"]
    assert stage.GetPrimAtPath("/scene").IsA(UsdPhysics.Scene)
    assert len([prim for prim in stage.Traverse() if prim.IsA(UsdPhysics.Scene)]) == 1
    robot = "/World/biped"
    drive = UsdPhysics.DriveAPI(stage.GetPrimAtPath(f"{robot}/left_ankle_pitch"), "angular")
    assert drive.GetStiffnessAttr().Get() == 1e6, "the user's drives are kept"
    foot, cover = (stage.GetPrimAtPath(f"{robot}/left_ankle/{name}") for name in ("foot", "cover"))
    assert not UsdPhysics.CollisionAPI(foot).GetCollisionEnabledAttr().Get()
    assert UsdPhysics.CollisionAPI(cover).GetCollisionEnabledAttr().Get(), "it does not stand on the ground"
    plate = stage.GetPrimAtPath(f"{robot}/left_bush_sole/plate")
    size, at = plate.GetAttribute("xformOp:scale").Get(), plate.GetAttribute("xformOp:translate").Get()
    assert (size[2], at[2] - size[2] / 2) == pytest.approx((0.01, -0.03)), "down to the sole"
    assert [[*corner] for corner in plate.GetAttribute("extent").Get()] == [[-0.5] * 3, [0.5] * 3]
    bound = plate.GetRelationship("material:binding:physics").GetTargets()
    assert [str(path) for path in bound] == ["/World/rubber"]
    masses = [UsdPhysics.MassAPI(stage.GetPrimAtPath(f"{robot}/{name}")).GetMassAttr().Get()
              for name in ("left_ankle", "left_bush_z_link", "left_bush_pitch_link", "left_bush_sole")]  # fmt: skip
    assert sum(masses) == pytest.approx(1.5)
    sole = UsdPhysics.FilteredPairsAPI(stage.GetPrimAtPath(f"{robot}/left_bush_sole"))
    apart = [str(path) for path in sole.GetFilteredPairsRel().GetTargets()]
    assert apart == [f"{robot}/left_ankle"], "a sole stands in its ankle's shapes"


@pytest.mark.parametrize(("mass", "left"), [(1.5, 1.35), (0.31, 0.16), (0.29, 0.29), (None, None)])
def test_what_a_bush_weighs_is_taken_off_an_ankle_that_can_spare_it(
    mass: float | None, left: float | None, tmp_path: Path
) -> None:
    """Half of it at most; a mass that the stage leaves to the engine stays so."""
    model = write_usd(tmp_path / "stage.usda")
    before, _, after = model.read_text().partition('"left_ankle"')
    given = "" if mass is None else f"float physics:mass = {mass}"
    model.write_text(before + '"left_ankle"' + after.replace("float physics:mass = 1.5", given, 1))
    export(result(write_urdf(tmp_path / "biped.urdf")), "usd", tmp_path / "out.usda", model=model)
    stage = stage_of(tmp_path / "out.usda")
    attribute = pxr.UsdPhysics.MassAPI(stage.GetPrimAtPath("/World/biped/left_ankle")).GetMassAttr()
    assert (attribute.Get() if attribute.HasAuthoredValue() else None) == (left and pytest.approx(left))


def test_joints_and_bodies_meet(tmp_path: Path) -> None:
    """Each joint's frame is in the same place of the world from either body, turned and moved as the robot is."""
    from pxr import UsdGeom, UsdPhysics

    stage = stage_of(written("over", tmp_path))
    cache = UsdGeom.XformCache()

    def frame(joint: Any, end: int) -> np.ndarray:
        relation = (joint.GetBody0Rel, joint.GetBody1Rel)[end]().GetTargets()[0]
        place = np.array((joint.GetLocalPos0Attr, joint.GetLocalPos1Attr)[end]().Get())
        turn = (joint.GetLocalRot0Attr, joint.GetLocalRot1Attr)[end]().Get()
        world = np.array(cache.GetLocalToWorldTransform(stage.GetPrimAtPath(relation))).T
        axes = [world[:3, :3] @ np.array(turn.Transform(pxr.Gf.Vec3f(*row))) for row in np.eye(3)]
        return np.vstack([world[:3, :3] @ place + world[:3, 3], *axes])

    for foot, axes in TRUTH.items():
        for axis in axes:
            joint = UsdPhysics.Joint(stage.GetPrimAtPath(f"/World/biped/{joint_name(foot, axis)}"))
            np.testing.assert_allclose(frame(joint, 0), frame(joint, 1), atol=1e-6)
            assert not joint.GetCollisionEnabledAttr().Get(), "a sole stands in its ankle's shapes"
    yaw = np.array([[np.cos(0.4), -np.sin(0.4), 0], [np.sin(0.4), np.cos(0.4), 0], [0, 0, 1]])
    joint = UsdPhysics.Joint(stage.GetPrimAtPath("/World/biped/LLEG_BUSH_PITCH"))
    np.testing.assert_allclose(frame(joint, 0)[0], yaw @ (CENTRE + [0, 0.1, 0.1]), atol=1e-6)
    np.testing.assert_allclose(frame(joint, 0)[1:].T, yaw @ bush_rotation("left"), atol=1e-6)


def test_overs_again_give_the_same(tmp_path: Path) -> None:
    one = written("over", tmp_path)
    made = result(tmp_path / "biped.urdf")
    made["parameters"][2]["value"] = 300.0
    export(made, "usd", tmp_path / "elsewhere" / "two.usda", model=one)
    from pxr import UsdPhysics

    stage = stage_of(tmp_path / "elsewhere" / "two.usda")
    drive = UsdPhysics.DriveAPI(stage.GetPrimAtPath("/World/biped/LLEG_BUSH_PITCH"), "angular")
    assert drive.GetStiffnessAttr().Get() == pytest.approx(300 * np.pi / 180)
    mass = UsdPhysics.MassAPI(stage.GetPrimAtPath("/World/biped/left_ankle")).GetMassAttr().Get()
    assert mass == pytest.approx(1.35), "taken off once"


def test_what_is_wrong_with_a_stage_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    urdf = write_urdf(tmp_path / "biped.urdf")
    (tmp_path / "result.json").write_text(json.dumps(result(urdf)))
    good = write_usd(tmp_path / "stage.usda").read_text()
    cases = {
        "not.usda": ("nonsense", "USD cannot open"),
        "centimetres.usda": (good.replace("metersPerUnit = 1", "metersPerUnit = 0.01"), "0.01 m"),
        "grams.usda": (good.replace("kilogramsPerUnit = 1", "kilogramsPerUnit = 0.001"), "0.001 kg"),
        "renamed.usda": (good.replace("left_ankle", "left_ancle"), "valid: left_ancle"),
    }
    for name, (text, words) in cases.items():
        (tmp_path / name).write_text(text)
        out = tmp_path / "out.usda"
        assert (
            run("export", tmp_path / "result.json", "--to", "usd", "--model", tmp_path / name, "--out", out)
            == 1
        )
        said = capsys.readouterr().err
        assert words in said
        assert said.count("\n") == 1
        assert not out.exists()


PHYSX_PROGRAM = """
import json, sys
import numpy as np
import ovphysx, ovstage
from ovphysx.samples.python_samples.schema_support import physx_schema_paths
from ovphysx.types import ObjectScope, SimObjectType

job = json.load(sys.stdin)
ovphysx.PhysX.set_cpu_mode(True)
ovstage.population.register_usd_schemas([*map(str, physx_schema_paths()), str(ovphysx.newton_schema_root())])
BODY = SimObjectType.ARTICULATION_LINK

def rows(query, attribute):
    found = {}
    with physx.read(query, [attribute]).wait() as reading:
        while (group := reading.fetch_next().wait()) is not None:
            paths = query.dictionary.get_path_strings(group.prim_list)
            paths = paths[group.prim_offset:group.prim_offset + group.prim_count]
            found |= {str(path): row.astype(float) for path, row in zip(paths, group.tensors[0].numpy())}
    return found

def matrix(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array([[1-2*(y*y+z*z), 2*(x*y-w*z), 2*(x*z+w*y)], [2*(x*y+w*z), 1-2*(x*x+z*z), 2*(y*z-w*x)],
                     [2*(x*z-w*y), 2*(y*z+w*x), 1-2*(x*x+y*y)]])

answers = []
for load in job["loads"]:
    physx = ovphysx.PhysX()
    stage = ovstage.Stage("pushed")
    ovstage.population.open_usd(stage, job["file"], ordinal=1, domains=ovstage.PopulationDomain.ALL)
    stage.advance_write_floor(ordinal=1).wait()
    physx.wait_task(physx.attach_ovstage(stage, read_ordinal=1))
    physx.wait_all()
    everything = physx.query(BODY, pattern=job["pattern"]).wait()

    def deflection():
        turns, places = rows(everything, "orientation"), rows(everything, "position")
        ankle = matrix(turns[load["ankle"]]) @ np.array(load["bush"])
        own = ankle.T @ matrix(turns[load["sole"]])
        moved = ankle.T @ (places[load["sole"]] - places[load["ankle"]])
        return {"pitch": np.arctan2(own[0, 2], own[2, 2]), "roll": -np.arcsin(own[1, 2]), "z": moved[2]}[load["axis"]]

    def advance(steps, size):
        ankle = matrix(rows(everything, "orientation")[load["ankle"]]) @ np.array(load["bush"])
        push = size * ankle[:, load["direction"]]
        for _ in range(steps):
            at = rows(everything, "position")[load["sole"]]
            wrench = np.r_[push, 0, 0, 0, at] if load["axis"] == "z" else np.r_[0, 0, 0, push, at]
            with physx.write_sync(BODY, "wrench", pattern=load["sole"]) as session:
                for group in session.groups:
                    group.tensors[0].assign(wrench[None].astype(np.float32))
                    session.commit_sync(group)
            physx.step_sync(job["step"])

    rest = deflection()
    advance(round(0.6 / job["step"]), load["load"])
    settled = deflection() - rest
    times, decay = [], []
    for count in range(round(0.4 / job["step"])):
        times.append(count * job["step"])
        decay.append(deflection() - rest)
        physx.step_sync(job["step"])
    answers.append({"settled": settled, "times": times, "decay": decay})
    physx.wait_task(physx.detach_ovstage())
    stage.destroy()
    physx.destroy()
print("\\n" + json.dumps(answers))
"""


def _as_articulation(layer: Path) -> None:
    """Hang each foot's ankle on the world, as a robot's would be: PhysX solves joints of light bodies well only so."""
    from pxr import UsdGeom, UsdPhysics

    stage = stage_of(layer)
    UsdPhysics.Scene.Define(stage, "/scene").CreateGravityMagnitudeAttr(0.0)
    for aside, foot in enumerate(TRUTH):
        # Each stands in its own ankle's frame: else in each other.
        place = pxr.Gf.Vec3d(0.0, float(aside), 0.0)
        UsdGeom.Xformable(stage.GetPrimAtPath(f"/feet/{foot}")).AddTranslateOp().Set(place)
        ankle = stage.GetPrimAtPath(f"/feet/{foot}/{foot}_ankle")
        UsdPhysics.ArticulationRootAPI.Apply(ankle)
        UsdPhysics.RigidBodyAPI(ankle).GetKinematicEnabledAttr().Set(False)
        joint = UsdPhysics.FixedJoint.Define(stage, f"/feet/{foot}/held")
        joint.CreateBody1Rel().SetTargets([ankle.GetPath()])
        joint.CreateLocalPos0Attr(pxr.Gf.Vec3f(place))
    stage.GetRootLayer().Save()


@pytest.mark.parametrize("kind", KINDS)
def test_physx_gives_stiffness_and_damping_back(kind: str, tmp_path: Path) -> None:
    python = other_python("PLANTAR_PHYSX_PYTHON", "ovphysx")
    out = written(kind, tmp_path)
    where = {"layer": "/feet/{0}/{0}_{1}", "over": "/World/biped/{0}_{1}"}[kind]
    cases = [(foot, axis) for foot, axes in TRUTH.items() for axis in axes]
    loads = [{"axis": axis, "sole": where.format(foot, "bush_sole"), "ankle": where.format(foot, "ankle"),
              "bush": bush_rotation(foot).tolist(), "direction": DIRECTION[axis], "load": LOAD[axis]}
             for foot, axis in cases]  # fmt: skip
    if kind == "layer":
        _as_articulation(out)
    job = {"file": str(out), "loads": loads, "step": 0.001,
           "pattern": where.split("{", 1)[0] + "**"}  # fmt: skip
    done = subprocess.run(
        [python, "-c", PHYSX_PROGRAM],
        input=json.dumps(job),
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    for (foot, axis), answer in zip(cases, json.loads(done.stdout.splitlines()[-1]), strict=True):
        check(foot, axis, LOAD[axis], answer["settled"], np.array(answer["times"]), np.array(answer["decay"]))


def test_usd_opens_with_openusd(feet: dict[str, Any], tmp_path: Path) -> None:
    from pxr import UsdPhysics

    export(feet, "usd", tmp_path / "f.usda")
    stage = stage_of(tmp_path / "f.usda")
    joints = [prim for prim in stage.Traverse() if prim.IsA(UsdPhysics.Joint)]
    assert len(joints) == 5
    drive = UsdPhysics.DriveAPI(stage.GetPrimAtPath("/feet/right/RLEG_BUSH_ROLL"), "angular")
    assert drive.GetStiffnessAttr().Get() == pytest.approx(323 * math.pi / 180, rel=1e-6)
