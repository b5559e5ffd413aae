"""Exports as text: every target's numbers, units and signs, and one clear line for what cannot be written.

References for the formats that nothing here can load: mc_rtc include/mc_rbdyn/Flexibility.h and
src/mc_rbdyn/configuration_io.cpp (flexibilities: jointName, K, C, O); openhrp3
sample/example/customizer/sample1_bush_customizer_param.conf; rtmros_choreonoid hrpsys_choreonoid/config
(bush: springT, dampingT, springR, dampingR); mc_state_observation etc/MCKineticsObserver/robots (linStiffness,
angStiffness, linDamping, angDamping); openusd.org UsdPhysicsDriveAPI (degrees).
"""

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
import yaml

from export_robots import CENTRE, SOLE_Z, TRUTH, bush_rotation, result, write_sdf
from plantar.cli import main
from plantar.errors import ExportError
from plantar.exporters import TARGETS, export
from plantar.exporters.bush import feet_of_result
from plantar.exporters.kinetics_observer import read_contacts
from plantar.exporters.mc_rtc import read_flexibilities
from usd_stage import write_usd

SIDES = {"left": "LLEG", "right": "RLEG"}


def stage_for(target: str, folder: Path) -> Path | None:
    """The model that a target cannot do without."""
    if target != "physx-contact":
        return None
    pytest.importorskip("pxr")
    return write_usd(folder / "stage.usda")


@pytest.mark.parametrize("target", TARGETS)
def test_every_target_writes_a_file_and_says_what_it_left_out(
    target: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    if target in ("mjcf", "mujoco-contact"):
        pytest.importorskip("mujoco")
    out = tmp_path / "deep" / f"feet.{target}"
    notes = export(feet, target, out, model=stage_for(target, tmp_path))
    assert out.stat().st_size > 100
    assert any("right z" in note.text for note in notes), (
        "the axis that was not identified is said to be rigid"
    )


def test_mc_rtc_flexibilities_are_the_identified_numbers(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "mc_rtc", tmp_path / "a.json", with_offset=True)
    entries = {e["jointName"]: e for e in json.loads((tmp_path / "a.json").read_text())["flexibilities"]}
    assert set(entries) == {
        "LLEG_BUSH_Z",
        "LLEG_BUSH_PITCH",
        "LLEG_BUSH_ROLL",
        "RLEG_BUSH_PITCH",
        "RLEG_BUSH_ROLL",
    }
    for foot, axes in TRUTH.items():
        for axis, (k, c, o) in axes.items():
            entry = entries[f"{SIDES[foot]}_BUSH_{axis.upper()}"]
            assert (entry["K"], entry["C"], entry["O"]) == pytest.approx((k, c, o))
    export(feet, "mc_rtc", tmp_path / "b.json")
    assert all(e["O"] == 0 for e in json.loads((tmp_path / "b.json").read_text())["flexibilities"])


def test_mc_rtc_and_the_observer_are_read_back(feet: dict[str, Any], tmp_path: Path) -> None:
    """What a reader finds pushes as plantar's law: the sign of the offset, radians, x for roll."""
    export(feet, "mc_rtc", tmp_path / "a.json", with_offset=True)
    found = read_flexibilities(tmp_path / "a.json")
    assert len(found) == 5
    for foot, axes in TRUTH.items():
        for axis, truth in axes.items():
            one = found[f"{SIDES[foot]}_BUSH_{axis.upper()}"]
            assert (one.stiffness, one.damping, one.offset) == pytest.approx(truth)
    export(feet, "kinetics_observer", tmp_path / "k.yaml")
    contacts = read_contacts(tmp_path / "k.yaml")
    assert contacts["pitch"] == pytest.approx((457, 20.08))
    assert contacts["roll"] == pytest.approx((337.5, 22.84))
    assert contacts["z"] == (40000, 400)


@pytest.mark.parametrize(
    "text",
    ["nonsense: [", "[1, 2]", '{"flexibilities": [{"jointName": "a", "K": 1}]}', "linStiffness: [1, 2, .nan]",
     '{"flexibilities": [{"jointName": "a", "K": -1, "C": 0, "O": 0}]}'],
)  # fmt: skip
def test_a_broken_configuration_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "a").write_text(text)
    for read in (read_flexibilities, read_contacts):
        with pytest.raises(ExportError, match="valid:"):
            read(tmp_path / "a")


def spoiled(feet: dict[str, Any], value: float, low: float, high: float) -> dict[str, Any]:
    """The feet, with a damping of left pitch that no log shows."""
    made = copy.deepcopy(feet)
    row = made["parameters"][3]
    assert (row["foot"], row["axis"], row["name"]) == ("left", "pitch", "damping")
    row.update(value=value, interval95=[low, high], std=(high - low) / 4, verdict="unidentifiable")
    return made


@pytest.mark.parametrize(
    ("interval", "written"),
    [((-12.0, 31.0), 0.96), ((22.6, 95.8), 22.6), ((0.1, 0.8), 0.8), ((-9.0, -1.0), 0.96)],
)
def test_a_damping_that_no_log_shows_is_not_exported(
    interval: tuple[float, float], written: float, feet: dict[str, Any], tmp_path: Path
) -> None:
    given = spoiled(feet, sum(interval) / 2, *interval)
    out = tmp_path / "a.json"
    notes = export(given, "mc_rtc", out)
    entries = {e["jointName"]: e for e in json.loads(out.read_text())["flexibilities"]}
    assert entries["LLEG_BUSH_PITCH"]["C"] == pytest.approx(written)
    assert entries["LLEG_BUSH_ROLL"]["C"] == TRUTH["left"]["roll"][1]
    (said,) = [note.text for note in notes if note.code == "export_damping"]
    assert f"95 % from {interval[0]:.4g} to {interval[1]:.4g}" in said
    assert f"= {written:.4g}" in said
    assert any(said in line for line in json.loads(out.read_text())["plantar"]), "the file says so too"


@pytest.mark.parametrize("target", ["mjcf", "sdf", "urdf", "drake", "usd", "openhrp"])
def test_no_target_holds_an_unidentifiable_damping(target: str, feet: dict[str, Any], tmp_path: Path) -> None:
    if target == "mjcf":
        pytest.importorskip("mujoco")
    out = tmp_path / "a"
    export(spoiled(feet, 9.87654, -12.0, 31.0), target, out)
    text = out.read_text()
    scale = math.pi / 180 if target == "usd" else 1
    assert "0.96" in text if scale == 1 else f"{0.96 * scale:.9g}" in text
    held = [line for line in text.splitlines() if "unidentifiable" not in line]
    assert not any(f"{9.87654 * scale:.6g}" in line for line in held)


@pytest.mark.parametrize("target", TARGETS)
def test_what_was_guessed_goes_along(target: str, feet: dict[str, Any], tmp_path: Path) -> None:
    if "mujoco" in target or target == "mjcf":
        pytest.importorskip("mujoco")
    said = "robot.yaml: marked GUESS and not measured: the left foot's numbers depend on bush"
    feet["notes"] = [{"code": "guessed_geometry", "severity": "warning", "text": said}]
    notes = export(feet, target, tmp_path / "a", model=stage_for(target, tmp_path))
    assert said in [note.text for note in notes if note.severity == "warning"]
    assert "marked GUESS" in (tmp_path / "a").read_text()


def test_choreonoid_takes_means(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "choreonoid", tmp_path / "c.yaml")
    bush = yaml.safe_load((tmp_path / "c.yaml").read_text())["bush"]
    assert bush["springT"] == 40000
    assert bush["springR"] == pytest.approx((480 + 352 + 434 + 323) / 4)
    assert bush["dampingR"] == pytest.approx((24.27 + 28.15 + 15.89 + 17.53) / 4)


def test_kinetics_observer_puts_roll_on_x_and_pitch_on_y(feet: dict[str, Any], tmp_path: Path) -> None:
    notes = export(feet, "kinetics_observer", tmp_path / "k.yaml")
    values = yaml.safe_load((tmp_path / "k.yaml").read_text())
    assert values["angStiffness"] == pytest.approx([(352 + 323) / 2, (480 + 434) / 2, 400])
    assert values["angDamping"] == pytest.approx([(28.15 + 17.53) / 2, (24.27 + 15.89) / 2, 12])
    assert values["linStiffness"] == [40000, 40000, 40000]
    assert values["linDamping"] == [120, 120, 400]
    assert "export_default" in {note.code for note in notes}


def test_yaml_keeps_every_number(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "yaml", tmp_path / "f.yaml")
    data = yaml.safe_load((tmp_path / "f.yaml").read_text())
    left = data["feet"]["left"]
    assert left["axes"]["pitch"]["stiffness"]["value"] == 480
    assert left["axes"]["roll"]["offset_by_motion"]["sway"]["value"] == pytest.approx(-4.62)
    assert left["bush_centre"] == CENTRE.tolist()
    np.testing.assert_allclose(left["bush_rotation"], bush_rotation("left"), atol=1e-12)


def test_usd_counts_angles_in_degrees(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "usd", tmp_path / "f.usda", with_offset=True)
    text = (tmp_path / "f.usda").read_text()
    assert text.startswith("#usda 1.0\n")
    joint = text[text.index('"LLEG_BUSH_PITCH"') :]
    values = {key: float(re.search(rf"angular:physics:{key} = (\S+)", joint)[1])  # type: ignore[index]
              for key in ("stiffness", "damping", "targetPosition")}  # fmt: skip
    assert values["stiffness"] == pytest.approx(480 * math.pi / 180)
    assert values["damping"] == pytest.approx(24.27 * math.pi / 180)
    assert values["targetPosition"] == pytest.approx(math.degrees(-5.66 / 480))
    slide = text[text.index('"LLEG_BUSH_Z"') :]
    assert float(re.search(r"linear:physics:stiffness = (\S+)", slide)[1]) == 40000  # type: ignore[index]
    assert text.count("{") == text.count("}")


def test_usd_opens_with_openusd(feet: dict[str, Any], tmp_path: Path) -> None:
    usd = pytest.importorskip("pxr.Usd", reason="usd-core is not installed")
    from pxr import UsdPhysics

    export(feet, "usd", tmp_path / "f.usda")
    stage = usd.Stage.Open(str(tmp_path / "f.usda"))
    joints = [prim for prim in stage.Traverse() if prim.IsA(UsdPhysics.Joint)]
    assert len(joints) == 5
    drive = UsdPhysics.DriveAPI(stage.GetPrimAtPath("/feet/right/RLEG_BUSH_ROLL"), "angular")
    assert drive.GetStiffnessAttr().Get() == pytest.approx(323 * math.pi / 180, rel=1e-6)


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

    from plantar.conventions import INERTIAL_NAMES

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
    export(made, "urdf", tmp_path / "identified.urdf", model=urdf)
    again = pin.buildModelFromUrdf(str(tmp_path / "identified.urdf"), pin.JointModelFreeFlyer())
    for joint, values in wanted.items():
        np.testing.assert_allclose(again.inertias[joint].toDynamicParameters(), values, rtol=1e-9, atol=1e-9)


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


def _broken(feet: dict[str, Any], **changes: Any) -> dict[str, Any]:
    made = copy.deepcopy(feet)
    for row in made["parameters"]:
        if row["foot"] == "left" and row["axis"] == "pitch" and row["name"] in changes:
            row["value"] = changes[row["name"]]
    return made


def test_what_cannot_be_written_is_one_clear_line(feet: dict[str, Any], urdf: Path, tmp_path: Path) -> None:
    out = tmp_path / "x"
    (tmp_path / "bomb.urdf").write_text('<!DOCTYPE r [<!ENTITY a "b">]><robot name="r"/>')
    wide = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE r [<!ENTITY a "b">]><robot name="r"/>'
    (tmp_path / "wide.urdf").write_text(wide, "utf-16")
    (tmp_path / "deep.urdf").write_text("<robot>" + "<a>" * 5000 + "</a>" * 5000 + "</robot>")
    (tmp_path / "cut.urdf").write_text(urdf.read_text()[:300])
    (tmp_path / "other.urdf").write_text('<robot name="o"><link name="lef_ankle"/></robot>')
    no_model = {key: value for key, value in feet.items() if key != "robot_model"}
    cases: list[tuple[dict[str, Any], str, Path | None, str]] = [
        (feet, "matlab", None, "not a target"),
        (no_model, "urdf", None, "robot_model"),
        (_broken(feet, stiffness=-3.0), "mc_rtc", None, "not positive"),
        (_broken(feet, stiffness="stiff"), "mc_rtc", None, "not a number"),
        (_broken(feet, damping=float("nan")), "yaml", None, "not a number"),
        (feet, "urdf", tmp_path / "bomb.urdf", "DOCTYPE"),
        (feet, "urdf", tmp_path / "wide.urdf", "DOCTYPE"),
        (feet, "urdf", tmp_path / "deep.urdf", "nested"),
        (feet, "urdf", tmp_path / "cut.urdf", "not readable XML"),
        (feet, "urdf", tmp_path / "other.urdf", "lef_ankle"),
        (feet, "urdf", tmp_path / "missing.urdf", "cannot be read"),
        (feet, "yaml", urdf, "takes no model"),
        ({"schema": "plantar.inertia/1"}, "urdf", None, "--model"),
        ({"schema": "plantar.inertia/1"}, "sdf", None, "plantar.inertia/1"),
        ({**feet, "schema": "plantar.joints/1"}, "yaml", None, "schema"),
    ]
    for data, target, model, expected in cases:
        with pytest.raises(ExportError, match=expected) as caught:
            export(data, target, out, model=model)
        assert "\n" not in str(caught.value)
    assert not out.exists()


def test_an_axis_without_a_value_is_rigid_and_a_negative_damper_becomes_a_small_one(
    feet: dict[str, Any], tmp_path: Path
) -> None:
    notes = export(_broken(feet, stiffness=None), "mc_rtc", tmp_path / "a.json")
    assert "LLEG_BUSH_PITCH" not in (tmp_path / "a.json").read_text()
    assert any("left pitch" in note.text for note in notes)
    notes = export(_broken(feet, damping=-1.0), "mc_rtc", tmp_path / "b.json")
    assert "export_damping" in {note.code for note in notes}
    entries = json.loads((tmp_path / "b.json").read_text())["flexibilities"]
    assert next(e for e in entries if e["jointName"] == "LLEG_BUSH_PITCH")["C"] == pytest.approx(480 * 0.002)


def test_a_vertical_stiffness_that_no_log_shows_is_rigid(feet: dict[str, Any], tmp_path: Path) -> None:
    for verdict, rigid in (("usable", False), ("unidentifiable", True)):
        made = copy.deepcopy(feet)
        for row in made["parameters"]:
            if row["axis"] == "z":
                row["verdict"] = verdict
        notes = export(made, "mc_rtc", tmp_path / f"{verdict}.json")
        assert ("BUSH_Z" not in (tmp_path / f"{verdict}.json").read_text()) is rigid
        assert any(note.text.startswith("left z: not identified") for note in notes) is rigid


def test_the_command_line(feet: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "result.json").write_text(json.dumps(feet))
    with pytest.raises(SystemExit) as done:
        main(["export", str(tmp_path / "result.json"), "--to", "mc_rtc", "--out", str(tmp_path / "f.json")])
    assert done.value.code == 0
    assert (tmp_path / "f.json").exists()
    with pytest.raises(SystemExit) as failed:
        main(["export", str(tmp_path / "result.json"), "--to", "lego", "--out", str(tmp_path / "g.json")])
    assert failed.value.code == 1
    assert "kinetics_observer" in capsys.readouterr().err


@pytest.mark.parametrize("target", ["urdf", "mjcf", "sdf", "usd", "drake"])
def test_the_joints_that_are_bushes_are_named(target: str, feet: dict[str, Any], tmp_path: Path) -> None:
    if target == "mjcf":
        pytest.importorskip("mujoco")
    notes = export(feet, target, tmp_path / "feet")
    (said,) = [note.text for note in notes if note.code == "export_joints"]
    named = re.findall(r"\w+_BUSH_\w+", said)
    written = (tmp_path / "feet").read_text()
    assert sorted(named) == sorted(set(re.findall(r"(?<![\w/])[LR]LEG_BUSH_(?:Z|PITCH|ROLL)\b", written)))
    assert "left foot LLEG_BUSH_Z, LLEG_BUSH_PITCH, LLEG_BUSH_ROLL;" in said
    assert "pitch about y, toes down > 0" in said
    assert "LLEG_BUSH_PITCH (left foot, pitch about y, toes down > 0): K" in written


def test_positive_is_toes_down_and_left_edge_up(feet: dict[str, Any]) -> None:
    found, _ = feet_of_result(feet, Path(), with_offset=False)
    for foot in found:
        axes = np.column_stack([foot.direction("roll"), foot.direction("pitch"), foot.direction("z")])
        forward, left, up = axes.T
        small = 0.1
        toes = forward + small * np.cross(foot.direction("pitch"), forward)
        edge = left + small * np.cross(foot.direction("roll"), left)
        assert toes @ up < 0
        assert edge @ up > 0


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
