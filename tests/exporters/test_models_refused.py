"""Models and results that no export can be made of: one line each, which says what and where."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_robots import write_mjcf, write_sdf, write_urdf
from plantar.conventions import rotation_from_rpy
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.poses import pose, rpy_of
from plantar.exporters.sdf.tree import SdfTree
from usd_stage import write_usd

Change = Callable[[dict[str, Any]], object]


def rows_of(feet: dict[str, Any], keep: Callable[[dict[str, Any]], bool]) -> None:
    feet["parameters"] = [row for row in feet["parameters"] if keep(row)]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda feet: feet["parameters"].clear(), "the result holds no parameters"),
        (lambda feet: rows_of(feet, lambda row: row["axis"] == "z" or row["foot"] == "right"),
         "foot 'left' has no stiffness in pitch or roll"),
        (lambda feet: feet["robot_model"]["feet"].pop("right"),
         "the result's robot_model has no foot 'right' (valid: left)"),
        (lambda feet: feet["robot_model"]["feet"]["left"].pop("sole"),
         "robot_model: a foot's entry is broken: 'sole' (valid: ankle, bush, sole)"),
        (lambda feet: feet["robot_model"]["feet"]["left"]["bush"].update(xyz=["a", 0, 0]),
         "robot_model: a foot's entry is broken: could not convert"),
        (lambda feet: feet["robot_model"].update(urdf=None), "the result names no URDF"),
        (lambda feet: feet["robot_model"].update(urdf="nowhere.urdf"), "nowhere.urdf: the result's URDF is not there"),
        (lambda feet: feet.update(schema="plantar.feet/9"), "a result of this schema cannot be exported"),
        (lambda feet: feet.pop("robot_model"), "the result holds no 'robot_model'"),
    ],
)  # fmt: skip
def test_a_result_that_lacks_something(
    change: Change, said: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    change(feet)
    with pytest.raises(ExportError) as refused:
        export(feet, "urdf", tmp_path / "out.urdf")
    assert said in str(refused.value)
    assert not (tmp_path / "out.urdf").exists()


def test_what_is_no_result_at_all(tmp_path: Path) -> None:
    with pytest.raises(
        ExportError,
        match=r"^value 'list': is not a result \(valid: a FeetResult or the path of a result\.json\)$",
    ):
        export([1, 2], "urdf", tmp_path / "out.urdf")  # type: ignore[arg-type]


SDF = """<sdf version="{version}"><model name="arm">
  <link name="ankle"><pose>0 0 1 0 0 0</pose>
    <collision name="foot"><geometry><mesh><uri>{uri}</uri><scale>2 1 1</scale></mesh></geometry></collision></link>
  <frame name="a" attached_to="b"/><frame name="b" attached_to="a"/>
  <frame name="held" attached_to="ankle"><pose>1 0 0 0 0 0</pose></frame>
  <frame name="free"><pose>0 2 0 0 0 0</pose></frame>
  <frame name="seen" attached_to="ankle"><pose relative_to="free">0 0 3 0 0 0</pose></frame>
</model></sdf>"""


def tree_of(folder: Path, version: str = "1.9", ankle: str = "ankle", uri: str = "foot.obj") -> SdfTree:
    (folder / "arm.sdf").write_text(SDF.format(version=version, uri=uri))
    return SdfTree.load(folder / "arm.sdf", (ankle,))


def test_frames_of_sdformat(tmp_path: Path) -> None:
    tree = tree_of(tmp_path)
    for name, place in (("held", (1, 0, 1)), ("free", (0, 2, 0)), ("seen", (0, 2, 3))):
        np.testing.assert_allclose(tree.in_model(name)[:3, 3], place)
    with pytest.raises(ExportError, match=r"arm.sdf: frame '[ab]' refers to itself"):
        tree.in_model("a")
    with pytest.raises(ExportError, match=r"arm.sdf: has no frame 'other'"):
        tree.in_model("other")
    with pytest.raises(ExportError, match=r"arm\.sdf: has no model with the link 'ankel' \(valid: ankle\)$"):
        tree_of(tmp_path, ankle="ankel")


def test_versions_of_sdformat(tmp_path: Path) -> None:
    assert tree_of(tmp_path, "1.5").version == (1, 5)
    assert [tree_of(tmp_path, version).relative_poses for version in ("1.6", "1.7", "1.12")] == [
        False,
        True,
        True,
    ]
    with pytest.raises(
        ExportError,
        match=r"arm\.sdf, value '1\.4': is of an SDFormat version too old \(valid: 1\.5 or later\)$",
    ):
        tree_of(tmp_path, "1.4")
    with pytest.raises(ExportError, match="has no SDFormat version"):
        tree_of(tmp_path, "new")


OBJ = "v 0.1 0 0\nv 0 0.2 0\nv 0 0 -0.3\nf 1 2 3\n"


@pytest.mark.parametrize("uri", ["foot.obj", "file://{folder}/foot.obj", "model://deep/foot.obj"])
def test_meshes_of_sdformat_lie_beside_the_model_or_above_it(uri: str, tmp_path: Path) -> None:
    place = {"foot.obj": tmp_path, "model://deep/foot.obj": tmp_path.parent / "deep"}.get(uri, tmp_path)
    place.mkdir(exist_ok=True)
    (place / "foot.obj").write_text(OBJ)
    tree = tree_of(tmp_path, uri=uri.format(folder=place))
    collision = tree.links["ankle"].find("collision")
    assert collision is not None
    points = tree.points(collision)
    assert points is not None
    np.testing.assert_allclose(np.ptp(np.vstack([points, np.zeros(3)]), axis=0), (0.2, 0.2, 0.3), atol=1e-6)
    (place / "foot.obj").unlink()
    assert tree.points(collision) is None


@pytest.mark.parametrize("target", ["urdf", "sdf"])
def test_a_mesh_that_cannot_be_read_goes_with_the_sole(
    target: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    model = write_urdf(tmp_path / "m.urdf") if target == "urdf" else write_sdf(tmp_path / "m.sdf", "1.9")
    whole = model.read_text()
    box = '<box size="0.08 0.08 0.05"/>' if target == "urdf" else "<box><size>0.08 0.08 0.05</size></box>"
    mesh = '<mesh filename="gone.stl"/>' if target == "urdf" else "<mesh><uri>gone.stl</uri></mesh>"
    assert box in whole
    model.write_text(whole.replace(box, mesh, 1))
    notes = export(feet, target, tmp_path / "out.xml", model=model)
    told = [note for note in notes if note.code == "export_mesh"]
    assert [(note.severity, note.text) for note in told] == [
        (
            "warning",
            "left: a collision mesh of 'left_ankle' cannot be read; taken for the foot and moved to the sole",
        )
    ]
    (moved,) = [note.text for note in notes if note.code == "export_moved" and note.text.startswith("left")]
    assert "cover" in moved
    assert "foot" in moved


@pytest.mark.parametrize("pitch", [-0.5, 0.5])
@pytest.mark.parametrize("roll", [-2.0, 0.3, 3.0])
def test_a_pose_that_looks_straight_up_or_down_keeps_its_turn(pitch: float, roll: float) -> None:
    place = pose(np.zeros(3), np.array([roll, pitch * np.pi, 0.7]))
    back = rpy_of(place)
    assert back[2] == 0.0
    np.testing.assert_allclose(rotation_from_rpy(back), place[:3, :3], atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('type="box" size="0.1 0.15 0.1"', 'type="box" size="0.1 0.15 0.1 7 7"', "MuJoCo refuses the model: "),
        ('name="left_ankle" pos', 'name="left_ankel" pos', "has no body 'left_ankle' (the ankle "
         "link of the robot file) (valid: left_ankel"),
        ('<geom name="left_cover" size="0.04 0.04 0.025"/>',
         '<frame><geom name="left_cover" size="0.04 0.04 0.025"/></frame>',
         "body 'left_ankle' makes its geoms by <frame>, <replicate> or <composite>"),
        ('<site name="left_ft"', '<body name="left_bush_sole"><geom size="0.01 0.01 0.01"/></body><site name="left_ft"',
         "the model already has a body 'left_bush_sole'"),
    ],
)  # fmt: skip
def test_mujoco_models_that_hold_no_bush(
    old: str, new: str, said: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    pytest.importorskip("mujoco")
    model = write_mjcf(tmp_path / "model.xml")
    assert old in model.read_text()
    model.write_text(model.read_text().replace(old, new))
    model.write_text(model.read_text().replace('body1="left_ankle" body2', 'body1="left_shin" body2'))
    with pytest.raises(ExportError) as refused:
        export(feet, "mjcf", tmp_path / "out.xml", model=model)
    assert said in str(refused.value)


def test_a_mesh_of_mujoco_reaches_as_far_as_its_corners(feet: dict[str, Any], tmp_path: Path) -> None:
    """Turned by 45 degrees, the box about it would reach the sole; its corners do not."""
    pytest.importorskip("mujoco")
    model = write_mjcf(tmp_path / "model.xml")
    corners = " ".join(f"{x} {y} {z}" for x in (-0.06, 0.06) for y in (-0.02, 0.02) for z in (-0.06, 0.06))
    asset = f'<asset><mesh name="hull" vertex="{corners}"/></asset><worldbody>'
    text = model.read_text().replace("<worldbody>", asset, 1)
    for place, moves in (('pos="0 0 -0.02" euler="0 0 0"', False), ('pos="0 0 -0.02" euler="0 45 0"', True)):
        geom = f'<geom name="left_cover" type="mesh" mesh="hull" {place}/>'
        model.write_text(text.replace('<geom name="left_cover" size="0.04 0.04 0.025"/>', geom))
        notes = export(feet, "mjcf", tmp_path / "out.xml", model=model)
        (moved,) = [
            note.text for note in notes if note.code == "export_moved" and note.text.startswith("left")
        ]
        assert ("left_cover" in moved) == moves


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("metersPerUnit = 1", "metersPerUnit = 0.01",
         "one unit of the stage is 0.01 m and 1 kg (valid: metersPerUnit = 1"),
        ("kilogramsPerUnit = 1", "kilogramsPerUnit = 0.5", "one unit of the stage is 1 m and 0.5 kg"),
        ('"left_ankle"', '"left_ankel"',
         "has no rigid body 'left_ankle' (the ankle link of the robot file) (valid: left_ankel"),
        ('    def Xform "biped"',
         '    def Xform "left_ankle" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {\n }\n    def Xform "biped"',
         "has several rigid bodies 'left_ankle': /World/left_ankle, /World/biped/left_ankle"),
        ("#usda 1.0", "#usdx", "USD cannot open the stage"),
    ],
)  # fmt: skip
def test_stages_that_hold_no_bush(
    old: str, new: str, said: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    pytest.importorskip("pxr", reason="no usd-core")
    model = write_usd(tmp_path / "stage.usda")
    assert old in model.read_text()
    model.write_text(model.read_text().replace(old, new))
    with pytest.raises(ExportError) as refused:
        export(feet, "usd", tmp_path / "out.usda", model=model)
    assert said in str(refused.value)


def test_a_stage_without_a_scene_gets_one_and_instances_are_set_apart(
    feet: dict[str, Any], tmp_path: Path
) -> None:
    pytest.importorskip("pxr", reason="no usd-core")
    from pxr import Usd, UsdPhysics

    model = write_usd(tmp_path / "stage.usda")
    text = model.read_text()
    scene = text[text.index("def PhysicsScene") : text.index("def Xform")]
    model.write_text(text.replace(scene, ""))
    notes = export(feet, "usd", tmp_path / "out.usda", model=model)
    assert "the stage had no PhysicsScene; one was added" in {note.text for note in notes}
    stage = Usd.Stage.Open(str(tmp_path / "out.usda"))
    assert [str(prim.GetPath()) for prim in stage.Traverse() if prim.IsA(UsdPhysics.Scene)] == [
        "/physicsScene"
    ]
    # The left foot's box comes from an instance of another place.
    lines = text.splitlines(keepends=True)
    start = next(i for i, line in enumerate(lines) if 'def Cube "foot"' in line)
    end = start + next(i for i, line in enumerate(lines[start:]) if line.strip() == "}") + 1
    box = "".join(lines[start:end])
    instance = 'def Xform "shapes" (instanceable = true\n prepend references = </foot_shapes>)\n{\n}\n'
    whole = "".join([*lines[:start], instance, *lines[end:]]) + f'\nclass Xform "foot_shapes"\n{{\n{box}}}\n'
    (other := tmp_path / "other.usda").write_text(whole)
    export(feet, "usd", tmp_path / "apart.usda", model=other)
    stage = Usd.Stage.Open(str(tmp_path / "apart.usda"))
    foot = stage.GetPrimAtPath("/World/biped/left_ankle/shapes/foot")
    assert not UsdPhysics.CollisionAPI(foot).GetCollisionEnabledAttr().Get()
    assert not stage.GetPrimAtPath("/World/biped/left_ankle/shapes").IsInstance()
