"""Feet on points as Drake's, Bullet's and PhysX' files hold them: the sums of statics, from the numbers in the file."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from export_robots import CENTRE, SOLE_Z, TRUTH, bush_rotation, result, write_mjcf, write_sdf, write_urdf
from plantar.conventions import GRAVITY
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.contact import drake
from plantar.exporters.contact.springs import RADIUS
from usd_stage import write_usd

TARGETS = ("drake-contact", "bullet-contact", "physx-contact")
WEIGHT = 31.0 * GRAVITY
DRAKE = "{http://drake.mit.edu}"


def written(target: str, folder: Path, made: dict[str, Any] | None = None, model: Path | None = None) -> Path:
    urdf = write_urdf(folder / "biped.urdf", rigid_legs=True)
    if target == "physx-contact" and model is None:
        pytest.importorskip("pxr", reason="no usd-core: pip install 'plantar[usd]'")
        model = write_usd(folder / "stage.usda")
    out = folder / f"out{len(list(folder.iterdir()))}{'.usda' if target == 'physx-contact' else '.xml'}"
    export(made or result(urdf), target, out, model=model)
    return out


def points_of(target: str, file: Path, foot: str) -> np.ndarray:
    """x, y, z of each sphere's centre in the bush's frame, its radius, k, c and friction, (n, 7)."""
    rows = []
    if target == "physx-contact":
        from pxr import Usd, UsdGeom, UsdPhysics

        stage = Usd.Stage.Open(str(file))
        for prim in stage.GetPrimAtPath(f"/World/biped/{foot}_ankle").GetChildren():
            if prim.GetName().startswith(f"{foot}_contact_"):
                material = prim.GetChild("material")
                bound = prim.GetRelationship("material:binding:physics").GetTargets()
                assert bound == [material.GetPath()], "else none of its numbers counts"
                k, c = (material.GetAttribute(f"physxMaterial:compliantContact{key}").Get()
                        for key in ("Stiffness", "Damping"))  # fmt: skip
                friction = UsdPhysics.MaterialAPI(material).GetDynamicFrictionAttr().Get()
                place = UsdGeom.Xformable(prim).GetLocalTransformation().ExtractTranslation()
                rows.append([*place, UsdGeom.Sphere(prim).GetRadiusAttr().Get(), k, c, friction])
    elif target == "drake-contact":
        for shape in ET.parse(file).getroot().iter("collision"):
            if shape.get("name", "").startswith(f"{foot}_contact_"):
                found = {key: float(shape.findtext(f"{DRAKE}proximity_properties/{DRAKE}{key}", "nan"))
                         for key in ("point_contact_stiffness", "relaxation_time", "mu_dynamic")}  # fmt: skip
                k = found["point_contact_stiffness"]
                place = [float(part) for part in shape.findtext("pose", "").split()[:3]]
                radius = float(shape.findtext("geometry/sphere/radius", "nan"))
                rows.append([*place, radius, k, k * found["relaxation_time"], found["mu_dynamic"]])
    else:
        root = ET.parse(file).getroot()
        for joint in root.findall("joint"):
            name = joint.get("name", "").removesuffix("_fixed")
            if name.startswith(f"{foot}_contact_"):
                link = root.find(f"link[@name='{name}']")
                values = [float(link.find(f"contact/{key}").get("value"))  # type: ignore[union-attr, arg-type]
                          for key in ("stiffness", "damping", "lateral_friction")]  # fmt: skip
                place = [float(part) for part in joint.find("origin").get("xyz").split()]  # type: ignore[union-attr]
                rows.append([*place, float(link.find(".//sphere").get("radius")), *values])  # type: ignore[union-attr, arg-type]
    found = np.array(rows)
    found[:, :3] = (found[:, :3] - CENTRE) @ bush_rotation(foot)
    return found


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("foot", TRUTH)
def test_the_numbers_in_the_file_turn_as_the_bush(target: str, foot: str, tmp_path: Path) -> None:
    """K is the torque that comes back about the bush centre from a small turn of the springs, by statics alone."""
    x, y, z, radius, k, c, _ = points_of(target, written(target, tmp_path), foot).T
    assert 4 <= len(x) <= 9
    bottom = z - radius  # each point's lowest place when the sole is flat
    load, sole = 0.5 * WEIGHT, SOLE_Z - CENTRE[2]

    def sinks(turn: float, arm: np.ndarray) -> np.ndarray:
        """How far each point is in the ground, at the height where they carry the load."""
        low, high = -0.05, 0.05
        for _ in range(100):
            middle = (low + high) / 2
            depth = np.maximum(middle - (bottom - sole) - turn * arm, 0)
            low, high = (middle, high) if float(k @ depth) < load else (low, middle)
        return depth

    for axis, arm in (("pitch", x), ("roll", y)):
        small = 1e-4
        torque = []
        for turn in (-small, small):
            push = k * sinks(turn, arm)
            torque.append(
                float(push @ (arm - z * turn))
            )  # a centre below the bush moves by its height times the turn
        stiffness = (torque[0] - torque[1]) / (2 * small)
        assert stiffness == pytest.approx(TRUTH[foot][axis][0], rel=2e-3)
        assert float(c @ arm**2) == pytest.approx(TRUTH[foot][axis][1], rel=2e-3)


@pytest.mark.parametrize("target", TARGETS)
def test_a_second_export_takes_the_place_of_the_first(target: str, tmp_path: Path) -> None:
    one = written(target, tmp_path)
    softer = copy.deepcopy(result(tmp_path / "biped.urdf"))
    softer["parameters"][2]["value"] = 300.0  # left pitch stiffness
    two = written(target, tmp_path, softer, model=one)
    old, new = (points_of(target, file, "right") for file in (one, two))
    np.testing.assert_allclose(new, old, rtol=1e-4, atol=1e-6)  # a light link of Bullet's weighs a gram
    old, new = (points_of(target, file, "left") for file in (one, two))
    assert new[:, 4].sum() < old[:, 4].sum()


@pytest.mark.parametrize("target", ["bullet-contact", "physx-contact"])
def test_the_middle_point_slides_and_the_others_have_its_friction(target: str, tmp_path: Path) -> None:
    file = written(target, tmp_path)
    found = points_of(target, file, "right")
    high = found[:, 2] > found[:, 2].min() + 1e-4
    assert high.sum() == 1
    assert found[high, 6] == 0
    given = 0.8 if target == "physx-contact" else 1.0
    assert found[~high, 6] == pytest.approx(given * 0.8 / 0.42, rel=0.05)  # the others sink a little with it
    assert points_of(target, file, "left")[:, 6] == pytest.approx(given), (
        "all as high as one another: all rub"
    )


def test_a_link_that_rubs_otherwise_leaves_its_friction_to_the_points(tmp_path: Path) -> None:
    urdf = write_urdf(tmp_path / "biped.urdf")
    rubs = '<contact><lateral_friction value="0.6"/></contact></link>'
    link, rest = urdf.read_text().split('<link name="left_ankle">')
    urdf.write_text(f'{link}<link name="left_ankle">{rest.replace("</link>", rubs, 1)}')
    export(result(urdf), "bullet-contact", tmp_path / "out.urdf")
    assert points_of("bullet-contact", tmp_path / "out.urdf", "left")[:, 6] == pytest.approx(0.6)
    right = points_of("bullet-contact", tmp_path / "out.urdf", "right")[:, 6]
    assert right.max() == pytest.approx(0.8 / 0.42, rel=0.05)


def test_what_touches_is_taken_from_the_model(tmp_path: Path) -> None:
    out = tmp_path / "out.sdf"
    model = write_sdf(tmp_path / "robot.sdf", "1.9")
    urdf = write_urdf(tmp_path / "biped.urdf")
    notes = export(result(urdf), "drake-contact", out, model=model)
    names = {shape.get("name", "") for shape in ET.parse(out).getroot().iter("collision")}
    assert "cover" in names
    assert "foot" not in names
    assert [note.text for note in notes if note.severity == "warning"] == [
        next(n.text for n in notes if "left z" in n.text and "cannot be had" in n.text)
    ]


def test_what_cannot_be_written_is_said(tmp_path: Path) -> None:
    urdf = write_urdf(tmp_path / "biped.urdf")
    with pytest.raises(
        ExportError, match=r"^PhysX' contact goes onto a stage \(valid: --model with the robot's USD stage\)$"
    ):
        export(result(urdf), "physx-contact", tmp_path / "out.usda")
    light = tmp_path / "light.urdf"
    text = urdf.read_text()
    for mass in ("20", "4", "1.5"):
        text = text.replace(f'<mass value="{mass}"/>', '<mass value="0"/>')
    light.write_text(text)
    for target in ("bullet-contact", "drake-contact"):
        with pytest.raises(ExportError, match="weigh nothing"):
            export(result(urdf), target, tmp_path / "out.xml", model=light)


CRATE = """    def Xform "crate" (prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])
    {
        float physics:mass = 60
    }

    def PhysicsFixedJoint "crate_stands"
    {
        rel physics:body0 = </World>
        rel physics:body1 = </World/crate>
    }

    def PhysicsFixedJoint "biped_hangs"
    {
        rel physics:body0 = </World>
        rel physics:body1 = </World/biped/pelvis>
    }

    def Xform "biped"
"""
BOX = '<body name="crate"><freejoint/><geom type="box" size="0.2 0.2 0.2" mass="60"/></body></worldbody>'


def test_what_else_is_in_a_stage_does_not_stand_on_the_feet(tmp_path: Path) -> None:
    pytest.importorskip("pxr", reason="no usd-core: pip install 'plantar[usd]'")
    stage = write_usd(tmp_path / "crate.usda")
    alone = points_of("physx-contact", written("physx-contact", tmp_path), "left")
    stage.write_text(stage.read_text().replace('    def Xform "biped"\n', CRATE))
    beside = points_of("physx-contact", written("physx-contact", tmp_path, model=stage), "left")
    np.testing.assert_array_equal(beside, alone)


def test_what_else_is_in_a_scene_does_not_stand_on_the_feet(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("mujoco")
    from plantar.exporters.contact import target

    asked: list[float] = []

    def weighed(foot: object, weight: float, least_load: float) -> None:
        asked.append(weight)
        raise ExportError("enough")

    monkeypatch.setattr(target, "fitted", weighed)
    model = write_mjcf(tmp_path / "scene.xml")
    for text in (model.read_text(), model.read_text().replace("</worldbody>", BOX)):
        model.write_text(text)
        with pytest.raises(ExportError, match="enough"):
            export(
                result(write_urdf(tmp_path / "biped.urdf")),
                "mujoco-contact",
                tmp_path / "out.xml",
                model=model,
            )
    assert asked[1] == asked[0] > 20 * GRAVITY


@pytest.mark.parametrize("given", ["", "drake", "ode", "both"])
def test_a_drake_point_rubs_as_what_it_takes_the_place_of(given: str, tmp_path: Path) -> None:
    own = "<drake:proximity_properties><drake:mu_dynamic>0.6</drake:mu_dynamic></drake:proximity_properties>"
    ode = "<surface><friction><ode><mu>0.7</mu></ode></friction></surface>"
    told = {"": "", "drake": own, "ode": ode, "both": own + ode}[given]
    model = write_sdf(tmp_path / "robot.sdf", "1.9")
    head, foot, rest = model.read_text().partition("<collision name='foot'>")
    head = head.replace("<sdf ", f'<sdf xmlns:drake="{DRAKE[1:-1]}" ', 1)
    shape, end, rest = rest.partition("</collision>")
    toe = f"<collision name='toe'>{shape}<surface><friction><ode><mu>0.3</mu></ode></friction></surface></collision>"
    model.write_text(f"{head}{foot}{told}{shape}{end}{toe if told else ''}{rest}")
    out = tmp_path / "out.sdf"
    notes = export(result(write_urdf(tmp_path / "biped.urdf")), "drake-contact", out, model=model)
    friction = {"": 1.0, "drake": 0.6, "ode": 0.7, "both": 0.6}[given]
    assert points_of("drake-contact", out, "left")[:, 6] == pytest.approx(friction)
    assert points_of("drake-contact", out, "right")[:, 6] == pytest.approx(1.0)
    for shape in ET.parse(out).getroot().iter("collision"):
        if "_contact_" in shape.get("name", ""):
            mu, static = (
                shape.findtext(f"{DRAKE}proximity_properties/{DRAKE}mu_{kind}")
                for kind in ("dynamic", "static")
            )
            assert mu == static
    said = [note.text for note in notes if "left out" in note.text]
    assert said == [
        f"{foot}: these shapes are left out, the points touch instead: {names}"
        for foot, names in (("left", "foot, toe" if told else "foot"), ("right", "foot"))
    ]
    again = export(result(tmp_path / "biped.urdf"), "drake-contact", tmp_path / "again.sdf", model=out)
    assert not [note for note in again if "left out" in note.text], "points of an earlier export"
    (ground,) = (note.text for note in notes if note.code == "export_ground")
    assert "1e+09 N/m or more" in ground


@pytest.mark.parametrize(("push", "carried"), [(120.0, 120.0), (0.0, 1e-3 * 9000.0 * RADIUS)])
def test_a_drake_point_damps_by_what_it_carries(push: float, carried: float) -> None:
    """Of one that hardly touches, by what a thousandth of its radius would."""
    ankle = ET.Element("link")
    point = SimpleNamespace(stiffness=9000.0, damping=45.0)
    drake._add(ankle, SimpleNamespace(point=point, name="p", centre=np.zeros(3), push=push), 0.6)  # type: ignore[arg-type]
    said = {key: float(next(ankle.iter(f"{DRAKE}{key}")).text or "nan") for key in
            ("point_contact_stiffness", "relaxation_time", "hunt_crossley_dissipation", "mu_static")}  # fmt: skip
    assert list(said.values()) == pytest.approx([9000.0, 0.005, 45.0 / carried, 0.6])


def test_in_a_stage_the_points_touch_the_ground_and_the_shapes_no_more(tmp_path: Path) -> None:
    from pxr import Usd, UsdPhysics

    stage = Usd.Stage.Open(str(written("physx-contact", tmp_path)))
    for side in ("left", "right"):
        touches = {
            name: UsdPhysics.CollisionAPI(
                stage.GetPrimAtPath(f"/World/biped/{side}_ankle/{name}")
            ).GetCollisionEnabledAttr().Get()
            for name in ("foot", "cover")
        }  # fmt: skip
        assert touches == {"foot": False, "cover": True}
