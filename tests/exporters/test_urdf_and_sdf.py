"""Exports into a robot's URDF or SDFormat model: what moves to the sole, and what stays."""

from __future__ import annotations

import copy
import json
import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_robots import CENTRE, SOLE_Z, bush_rotation, result, write_sdf
from plantar.conventions import INERTIAL_NAMES
from plantar.errors import ExportError
from plantar.exporters import export


def test_urdf_moves_what_stands_on_the_ground(feet: dict[str, Any], urdf: Path, tmp_path: Path) -> None:
    export(feet, "urdf", tmp_path / "out.urdf")
    root = ET.parse(tmp_path / "out.urdf").getroot()
    links = {link.get("name"): link for link in root.findall("link")}
    joints = {joint.get("name"): joint for joint in root.findall("joint")}
    assert [c.get("name") for c in links["left_ankle"].findall("collision")] == ["cover"]
    assert [c.get("name") for c in links["left_bush_sole"].findall("collision")] == ["foot"]
    assert joints["left_sole_fix"].find("parent").get("link") == "left_bush_sole"  # type: ignore[union-attr]
    assert joints["left_sensor_fix"].find("parent").get("link") == "left_ankle"  # type: ignore[union-attr]
    spring = next(e for e in root.findall("gazebo") if e.get("reference") == "RLEG_BUSH_PITCH")
    assert float(spring.findtext("springStiffness", "")) == 434
    assert float(spring.findtext("springReference", "")) == 0
    assert float(joints["RLEG_BUSH_PITCH"].find("dynamics").get("damping")) == 15.89  # type: ignore[union-attr,arg-type]


def test_urdf_export_twice_updates_instead_of_stacking(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "urdf", tmp_path / "one.urdf")
    softer = copy.deepcopy(feet)
    softer["parameters"][2]["value"] = 300.0  # left pitch stiffness
    notes = export(softer, "urdf", tmp_path / "two.urdf", model=tmp_path / "one.urdf")
    text = (tmp_path / "two.urdf").read_text()
    assert text.count('<joint name="LLEG_BUSH_PITCH"') == 1
    assert "<springStiffness>300</springStiffness>" in text
    assert text.count("<springStiffness>") == 5
    assert "export_updated" in {note.code for note in notes}


@pytest.mark.parametrize("target", ["urdf", "sdf", "drake", "mjcf"])
def test_a_model_whose_bush_lacks_an_axis_of_the_result_is_refused(
    target: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    """A second chain beside the first would have links and joints of the same names."""
    suffix = {"urdf": ".urdf", "mjcf": ".xml"}.get(target, ".sdf")
    one, two = tmp_path / f"one{suffix}", tmp_path / f"two{suffix}"
    rigid = copy.deepcopy(feet)
    rigid["parameters"] = [row for row in feet["parameters"] if row["axis"] != "z"]
    export(rigid, target, one)
    with pytest.raises(ExportError, match=r"without LLEG_BUSH_Z.*valid: a model without bushes"):
        export(feet, target, two, model=one)
    export(feet, target, one)
    if target == "drake":  # its joints have no springs of their own: a slide without one would drop the robot
        with pytest.raises(
            ExportError,
            match=r"one\.sdf: has the bush of 'left' with LLEG_BUSH_Z, which the result has not: it would "
            r"move freely \(valid: a model without bushes\)$",
        ):
            export(rigid, target, two, model=one)
    else:
        # As a robot's own model, whose slide stays as it is there, and that is told.
        notes = export(rigid, target, two, model=one)
        (told,) = [one for one in notes if one.code == "export_updated" and one.severity == "warning"]
        assert told.text.startswith("left: ")
        assert "but not those of LLEG_BUSH_Z, of which the result knows nothing" in told.text


@pytest.mark.parametrize("version", ["1.5", "1.6", "1.9"])
def test_sdf_models_of_both_pose_grammars(version: str, feet: dict[str, Any], tmp_path: Path) -> None:
    model = write_sdf(tmp_path / "robot.sdf", version)
    export(feet, "sdf", tmp_path / "out.sdf", model=model, with_offset=True)
    from plantar.exporters.sdf.tree import SdfTree, relative

    tree = SdfTree.load(tmp_path / "out.sdf", ("left_ankle",))
    place = relative(tree, "left_bush_sole", "left_ankle")
    np.testing.assert_allclose(place[:3, 3], CENTRE, atol=1e-9)
    np.testing.assert_allclose(place[:3, :3], bush_rotation("left"), atol=1e-9)
    np.testing.assert_allclose(relative(tree, "left_sole", "left_ankle")[:3, 3], [0, 0, SOLE_Z], atol=1e-9)
    assert tree.joints["left_sole_fix"].findtext("parent") == "left_bush_sole"
    assert [c.get("name") for c in tree.links["left_bush_sole"].findall("collision")] == ["foot"]
    dynamics = tree.joints["LLEG_BUSH_ROLL"].find("axis/dynamics")
    assert dynamics is not None
    assert float(dynamics.findtext("spring_stiffness", "")) == 352
    assert float(dynamics.findtext("damping", "")) == 28.15
    assert float(dynamics.findtext("spring_reference", "")) == pytest.approx(4.12 / 352)


def test_identified_urdf_gives_pinocchio_the_parameters(urdf: Path, tmp_path: Path) -> None:
    import pinocchio as pin

    inertia = "<inertia ixx='.01' ixy='0' ixz='0' iyy='.01' iyz='0' izz='.01'/>"
    sensor = f'<link name="left_sensor"><inertial><mass value="0.7"/>{inertia}</inertial></link>'
    urdf.write_text(urdf.read_text().replace('<link name="left_sensor"/>', sensor))
    model = pin.buildModelFromUrdf(str(urdf), pin.JointModelFreeFlyer())
    pin.seed(1)
    wanted, rows = {}, []
    for joint in range(1, model.njoints):
        link = next(f.name for f in model.frames if f.parentJoint == joint and f.type == pin.FrameType.BODY)
        values = (model.inertias[joint] + pin.Inertia.Random()).toDynamicParameters()
        wanted[joint] = values
        rows += [{"link": link, "name": name, "unit": "", "value": float(value), "cad": 0.0}
                 for name, value in zip(INERTIAL_NAMES, values, strict=True)]  # fmt: skip
    made = {"schema": "plantar.inertia/1", "robot": "biped", "plantar": "0.1.0", "inertial_parameters": rows}
    notes = export(made, "urdf", tmp_path / "identified.urdf", model=urdf)
    assert {note.code for note in notes} == {"export_inertia", "export_lumped"}
    text = (tmp_path / "identified.urdf").read_text()
    assert "Inertias of 'biped', identified by plantar 0.1.0." in text
    for note in notes:
        assert f"{note.severity}: {note.text}" in text, "it is told in the file too"
    again = pin.buildModelFromUrdf(str(tmp_path / "identified.urdf"), pin.JointModelFreeFlyer())
    for joint, values in wanted.items():
        np.testing.assert_allclose(again.inertias[joint].toDynamicParameters(), values, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("link", "lost", "value", "said"),
    [
        (
            "left_shin",
            "Iyy",
            1.0,
            r"^link 'left_shin' has no parameter Iyy \(valid: m, mx, my, mz, Ixx, Ixy, Iyy, Ixz, Iyz, "
            r"Izz\)$",
        ),
        (
            "left_shine",
            "",
            1.0,
            r"^the URDF has no link 'left_shine' \(valid: left_shin, left_sole, left_ankle\)$",
        ),
        ("left_shin", "", -1.0, "link 'left_shin' has the identified mass -1 kg"),
        ("", "", 1.0, r"^the result holds no inertial_parameters \(valid: a result of identify inertia\)$"),
    ],
)
def test_inertias_that_a_urdf_cannot_have_are_refused(
    link: str, lost: str, value: float, said: str, urdf: Path, tmp_path: Path
) -> None:
    rows = [{"link": link, "name": name, "value": value} for name in INERTIAL_NAMES if link and name != lost]
    made = {"schema": "plantar.inertia/1", "robot": "biped", "plantar": "0.1.0", "inertial_parameters": rows}
    with pytest.raises(ExportError, match=said):
        export(made, "urdf", tmp_path / "o.urdf", model=urdf)
    assert not (tmp_path / "o.urdf").exists()


def test_a_foot_of_another_name_and_no_sole_shape(tmp_path: Path, urdf: Path) -> None:
    text = re.sub(r'<collision name="foot">.*?</collision>', "", urdf.read_text())
    urdf.write_text(text)
    made = result(urdf)
    made["robot_model"]["feet"]["hoof"] = made["robot_model"]["feet"].pop("left")
    for row in (*made["parameters"], *made["offsets"]):
        row["foot"] = "hoof" if row["foot"] == "left" else row["foot"]
    notes = export(made, "urdf", tmp_path / "o.urdf")
    assert "export_plate" in {note.code for note in notes}
    root = ET.parse(tmp_path / "o.urdf").getroot()
    assert any(joint.get("name") == "hoof_bush_pitch" for joint in root.findall("joint"))
    sole = next(link for link in root.findall("link") if link.get("name") == "hoof_bush_sole")
    size = [float(v) for v in sole.find("collision/geometry/box").get("size").split()]  # type: ignore[union-attr]
    # The outline, turned by the bush's 0.3 rad of yaw, in its own bounding box.
    c, s = math.cos(0.3), math.sin(0.3)
    assert size[:2] == pytest.approx([0.2 * c + 0.12 * s, 0.2 * s + 0.12 * c], abs=1e-6)


@pytest.mark.parametrize("target", ["urdf", "sdf", "mjcf"])
def test_a_bush_in_the_soles_plane_takes_the_foot_along(target: str, urdf: Path, tmp_path: Path) -> None:
    if target == "mjcf":
        pytest.importorskip("mujoco")
    made = result(urdf)
    for entry in made["robot_model"]["feet"].values():
        entry["bush"]["xyz"] = [0.0, 0.0, SOLE_Z]
    notes = export(made, target, tmp_path / "out")
    moved = [note.text for note in notes if note.code == "export_moved"]
    assert len(moved) == 2
    assert all("_sole" in text.split("sole:")[1] for text in moved)
    assert "export_plate" not in {note.code for note in notes}


def test_the_urdf_is_found_from_the_folder_in_which_identify_ran(
    feet: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A result in out/feet names the URDF as seen from where the command ran."""
    urdf = Path(feet["robot_model"]["urdf"]).read_text()
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "robot.urdf").write_text(urdf)
    folder = tmp_path / "out" / "feet"
    folder.mkdir(parents=True)
    content = {**feet, "robot_model": {**feet["robot_model"], "urdf": "robots/robot.urdf"}}
    (folder / "result.json").write_text(json.dumps(content))
    monkeypatch.chdir(folder)
    export("result.json", "urdf", "robot.urdf")
    assert "LLEG_BUSH_PITCH" in Path("robot.urdf").read_text()


def test_meshes_that_mujoco_reads_stay_in_its_model(feet: dict[str, Any], urdf: Path, tmp_path: Path) -> None:
    """Another format is left out, and named."""
    pytest.importorskip("mujoco")
    corners = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
    faces = [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)]
    obj = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a} {b} {c}" for a, b, c in faces]
    (tmp_path / "a.obj").write_text("\n".join(obj) + "\n")
    (tmp_path / "c.dae").write_text("<COLLADA/>")
    shapes = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    shapes += "".join(
        f'<collision><geometry><mesh filename="{name}"/></geometry></collision>'
        for name in ("a.obj", "c.dae")
    )
    text = urdf.read_text().replace('<link name="pelvis">', f'<link name="pelvis">{shapes}', 1)
    urdf.write_text(text)
    notes = export(feet, "mjcf", tmp_path / "out.xml", model=urdf)
    (lost,) = [note.text for note in notes if note.code == "export_mesh"]
    assert lost.endswith(": c.dae")
    pelvis = ET.parse(tmp_path / "out.xml").getroot().find(".//body[@name='pelvis']")
    assert [geom.get("mesh") for geom in pelvis.findall("geom")] == [None, "a"]  # type: ignore[union-attr]


FOOT = r'(<link name="left_ankle">.*?)(<collision name="foot">.*?</collision>)'


@pytest.mark.parametrize("target", ["urdf", "sdf", "drake"])
def test_the_foots_shape_in_a_link_fixed_to_the_ankle_goes_with_the_sole(
    target: str, urdf: Path, tmp_path: Path
) -> None:
    """Left with the ankle it would carry the ground's force past the bush."""
    text = urdf.read_text()
    found = re.search(FOOT, text)
    assert found is not None
    fixed = f'<link name="left_shoe">{found[2]}</link><joint name="left_shoe_fix" type="fixed"><origin xyz="0 0 0.02"/>'
    fixed += '<parent link="left_ankle"/><child link="left_shoe"/></joint></robot>'
    urdf.write_text(text.replace(found[0], found[1]).replace("</robot>", fixed.replace("-0.09", "-0.11")))
    export(result(urdf), target, tmp_path / "out")
    root = ET.parse(tmp_path / "out").getroot()
    links = {link.get("name"): link for link in root.iter("link")}
    assert not links["left_shoe"].findall("collision")
    (shape,) = links["left_bush_sole"].findall("collision")
    place = shape.findtext("pose", "").split()[:3] or shape.find("origin").get("xyz").split()  # type: ignore[union-attr]
    np.testing.assert_allclose([float(part) for part in place], [0, 0, -0.09 - CENTRE[2]], atol=1e-9)


@pytest.mark.parametrize("target", ["urdf", "sdf", "drake"])
def test_a_sole_behind_a_sensor_is_cut_off_by_the_bush(target: str, urdf: Path, tmp_path: Path) -> None:
    """Ankle, sensor and sole are fixed one to the next: what lies below the bush centre goes, however deep it hangs."""
    text = urdf.read_text()
    chain = (
        f'<origin xyz="0 0 {SOLE_Z}"/><parent link="left_ankle"/>',
        f'<origin xyz="0 0 {SOLE_Z + 0.05}"/><parent link="left_sensor"/>',
    )
    assert text.count(chain[0]) == 1
    urdf.write_text(text.replace(*chain))
    export(result(urdf), target, tmp_path / "out")
    root = ET.parse(tmp_path / "out").getroot()
    joint = next(joint for joint in root.iter("joint") if joint.get("name") == "left_sole_fix")
    parent = joint.find("parent")
    assert parent is not None
    assert (parent.get("link") or parent.text) == "left_bush_sole"


def test_an_sdf_made_from_a_urdf_keeps_each_links_centre_of_mass(feet: dict[str, Any], urdf: Path) -> None:
    out = urdf.with_name("out.sdf")
    export(feet, "sdf", out)
    shin = ET.parse(out).getroot().find(".//link[@name='left_shin']/inertial")
    assert shin is not None
    assert (shin.findtext("mass"), shin.findtext("inertia/ixx")) == ("4", "0.05")
    assert [float(part) for part in shin.findtext("pose", "").split()] == [0, 0, -0.2, 0, 0, 0]


def test_an_sdf_made_from_a_urdf_keeps_friction_meshes_and_their_scale(
    feet: dict[str, Any], urdf: Path
) -> None:
    mesh = '<visual><geometry><mesh filename="shin.stl" scale="1 2 0.5"/></geometry></visual></link>'
    text = urdf.read_text().replace("</link>", mesh, 1)
    text = text.replace("</joint>", '<dynamics damping="0.5" friction="0.25"/></joint>', 1)
    urdf.write_text(text)
    export(feet, "sdf", urdf.with_name("out.sdf"))
    root = ET.parse(urdf.with_name("out.sdf")).getroot()
    (found,) = root.iter("mesh")
    assert (found.findtext("uri"), found.findtext("scale", "").split()) == ("shin.stl", ["1", "2", "0.5"])
    jointed = re.search(r'<joint name="(\w+)"', text)
    assert jointed is not None
    axis = root.find(f".//joint[@name='{jointed[1]}']/axis/dynamics")
    assert axis is not None
    assert (axis.findtext("damping"), axis.findtext("friction")) == ("0.5", "0.25")


def test_a_joint_that_sdformat_has_no_word_for_is_named(feet: dict[str, Any], urdf: Path) -> None:
    kinds = re.sub(r'(<joint name="left_hip" type=)"\w+"', r'\1"planar"', urdf.read_text())
    assert "planar" in kinds
    urdf.write_text(kinds)
    with pytest.raises(
        ExportError, match=r"value 'planar': joint 'left_hip' is of a type that is not carried"
    ):
        export(feet, "sdf", urdf.with_name("out.sdf"))


def test_a_foot_without_a_shape_has_a_plate_down_to_its_sole(urdf: Path, tmp_path: Path) -> None:
    urdf.write_text(re.sub(r'<collision name="foot">.*?</collision>', "", urdf.read_text()))
    notes = export(result(urdf), "sdf", tmp_path / "o.sdf")
    assert {note.text.split(":")[0] for note in notes if note.code == "export_plate"} == {"left", "right"}
    plate = ET.parse(tmp_path / "o.sdf").getroot().find(".//collision[@name='right_bush_plate']")
    assert plate is not None
    length, width, height = map(float, plate.findtext("geometry/box/size", "").split())
    x, y, z = map(float, plate.findtext("pose", "").split()[:3])
    assert (length, width) == pytest.approx((0.2, 0.12))
    assert (x, y, z - height / 2) == pytest.approx((-CENTRE[0], 0.0, SOLE_Z - CENTRE[2]))


def test_a_second_sdf_export_leaves_one_spring_in_each_joint(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "sdf", tmp_path / "one.sdf")
    softer = copy.deepcopy(feet)
    softer["parameters"][2]["value"] = 300.0  # left pitch stiffness
    export(softer, "sdf", tmp_path / "two.sdf", model=tmp_path / "one.sdf")
    springs = {
        joint.get("name"): [float(one.text or "nan") for one in joint.iter("spring_stiffness")]
        for joint in ET.parse(tmp_path / "two.sdf").getroot().iter("joint")
    }
    assert springs["LLEG_BUSH_PITCH"] == [300.0]
    assert {name for name, found in springs.items() if len(found) > 1} == set()


@pytest.mark.parametrize("kind", ["fixed", "floating"])
@pytest.mark.parametrize("target", ["sdf", "mjcf"])
def test_a_urdf_that_hangs_on_the_world_is_the_same_without(
    target: str, kind: str, feet: dict[str, Any], urdf: Path, tmp_path: Path
) -> None:
    if target == "mjcf":
        pytest.importorskip("mujoco")
    export(feet, target, tmp_path / f"free.{target}", model=urdf)
    root = ET.parse(urdf).getroot()
    ends = {str(end.get("link")) for end in root.iterfind("joint/child")}
    trunk = next(str(link.get("name")) for link in root.findall("link") if link.get("name") not in ends)
    joint = f'<joint name="stand" type="{kind}"><parent link="world"/><child link="{trunk}"/></joint>'
    (tmp_path / "world.urdf").write_text(
        urdf.read_text().replace("</robot>", f'<link name="world"/>{joint}</robot>')
    )
    notes = export(feet, target, tmp_path / f"world.{target}", model=tmp_path / "world.urdf")
    assert "export_world" in {note.code for note in notes}
    free, hung = (
        ET.tostring(ET.parse(tmp_path / f"{name}.{target}").getroot()) for name in ("free", "world")
    )  # comments are not parsed
    assert free == hung
