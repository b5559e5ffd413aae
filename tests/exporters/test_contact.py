"""Feet on points in the file that a user gets.

The pushes on the exported file know nothing of how the points were found: a load and a torque at the bush centre of the
robot file, and the angle of the robot that stands on that foot.
"""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_robots import CENTRE, TRUTH, bush_rotation, result, write_mjcf, write_urdf
from plantar.conventions import GRAVITY, Axis
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.contact.fit import STEPS
from plantar.exporters.openhrp import read_customizer
from plantar.exporters.spring import Slip

SWAY = 3.0

mujoco = pytest.importorskip("mujoco")
ROTATIONS: tuple[Axis, ...] = ("pitch", "roll")


@pytest.fixture(scope="module", params=["mjcf", "urdf"])
def exported(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any]:
    """A user's MJCF, and a URDF turned into one, both with legs of one piece; and the notes."""
    folder = tmp_path_factory.mktemp(request.param)
    urdf = write_urdf(folder / "biped.urdf", rigid_legs=request.param == "urdf")
    model = write_mjcf(folder / "robot.xml") if request.param == "mjcf" else None
    if model is not None:  # hinges away: the robot is one body on two feet
        root = ET.parse(model).getroot()
        for body in root.iter("body"):
            for joint in body.findall("joint"):
                body.remove(joint)
        for tag in ("actuator", "keyframe", "sensor"):
            for section in root.findall(tag):
                root.remove(section)
        model.write_text(ET.tostring(root, encoding="unicode"))
    out = folder / "elsewhere" / "out.xml"
    return out, export(result(urdf), "mujoco-contact", out, model=model)


@pytest.mark.parametrize(
    ("foot", "axis", "share"),
    [("left", "pitch", 0.5), ("left", "roll", 1.0), ("right", "pitch", 1.0), ("right", "roll", 0.5)],
)
def test_the_file_that_a_user_gets_turns_as_identified(
    exported: tuple[Path, Any], foot: str, axis: Axis, share: float
) -> None:
    model = mujoco.MjModel.from_xml_path(str(exported[0]))
    other = "right" if foot == "left" else "left"
    for geom in range(model.ngeom):
        if model.geom(geom).name.startswith(f"{other}_contact_"):
            model.geom_contype[geom] = model.geom_conaffinity[geom] = 0
    weight = float(model.body_mass.sum()) * GRAVITY
    model.opt.gravity[:] = 0
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    ankle, pelvis = model.body(f"{foot}_ankle").id, model.body("pelvis").id
    k, c, _ = TRUTH[foot][axis]
    in_ankle = bush_rotation(foot)[:, {"roll": 0, "pitch": 1}[axis]]

    def pushed(torque: float) -> float:
        """Turn about the bush's axis after one step under a load straight down at the bush centre and a torque."""
        turn = data.xmat[ankle].reshape(3, 3)
        bush_axis = turn @ in_ankle
        at = data.xpos[ankle] + turn @ CENTRE
        x, y, _ = at - data.xipos[pelvis]
        data.xfrc_applied[pelvis, 2] = -share * weight
        data.xfrc_applied[pelvis, 3:] = share * weight * np.array([-y, x, 0.0]) + torque * bush_axis
        mujoco.mj_step(model, data)
        return float(2 * np.array(data.qpos[4:7]) @ bush_axis)

    step, torque = model.opt.timestep, 3.0
    # The robot's own inertia swings on the foot: friction of its own lets it come to rest, and is taken off C again.
    swing = 12.0
    model.dof_damping[3:6] = own = 30.0
    times = np.arange(round(2.2 / step)) * step  # it is at rest in its swing after some tenths of a second
    angles = np.array([pushed(torque * np.cos(swing * time)) for time in times])
    last = times > times[-1] - 3 * 2 * np.pi / swing
    late = times[last] + step
    basis = np.column_stack([np.cos(swing * late), -np.sin(swing * late), np.ones(late.size)])
    real, imaginary, _ = np.linalg.lstsq(basis, angles[last], rcond=None)[0]
    response = torque / complex(real, imaginary)
    assert response.imag / swing - own == pytest.approx(c, rel=0.15)
    ends = []
    for sign in (1, -1):
        mujoco.mj_resetData(model, data)
        mujoco.mj_kinematics(model, data)
        ends.append(np.mean([pushed(sign * torque) for _ in range(round(1.2 / step))][-50:]))
    assert 2 * torque / (ends[0] - ends[1]) == pytest.approx(k, rel=0.05)


@pytest.mark.parametrize("step", STEPS)
def test_the_robot_stays_and_only_the_points_touch(exported: tuple[Path, Any], step: float) -> None:
    model = mujoco.MjModel.from_xml_path(str(exported[0]))
    model.opt.timestep = step
    assert model.nv == 6, "no joint was added"
    names = {model.geom(geom).name: geom for geom in range(model.ngeom)}
    for side in TRUTH:
        points = [geom for name, geom in names.items() if name.startswith(f"{side}_contact_")]
        assert 4 <= len(points) <= 17
        assert model.geom_contype[points].all()
    data = mujoco.MjData(model)
    for _ in range(round(3 / step)):
        mujoco.mj_step(model, data)
    touching = {model.geom(geom).name for contact in data.contact for geom in contact.geom} - {"floor"}
    assert touching == {name for name in names if "_contact_" in name and "_second_" not in name}
    # It stands where it stood, on the points' height: within what the feet sink and the edges reach.
    weight = float(model.body_mass.sum()) * GRAVITY
    force = sum(data.efc_force[contact.efc_address] for contact in data.contact)
    assert force == pytest.approx(weight, rel=0.02)
    # The left foot's z is softer than points that turn like it: said, and nothing else is.
    assert {note.code for note in exported[1] if note.severity == "warning"} == {"export_vertical"}
    assert {"export_contact", "export_vertical", "export_friction"} <= {note.code for note in exported[1]}


@pytest.fixture
def one_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contacts are looked at with one step alone, which takes a third of the time."""
    monkeypatch.setattr("plantar.exporters.contact.fit.STEPS", (0.001,))


def test_a_second_export_takes_the_place_of_the_first(tmp_path: Path, one_step: None) -> None:
    made = result(write_urdf(tmp_path / "b.urdf"))
    export(made, "mujoco-contact", tmp_path / "one.xml")
    softer = copy.deepcopy(made)
    softer["parameters"][2]["value"] = 300.0  # left pitch stiffness
    export(softer, "mujoco-contact", tmp_path / "two.xml", model=tmp_path / "one.xml")
    one, two = (mujoco.MjModel.from_xml_path(str(tmp_path / f"{name}.xml")) for name in ("one", "two"))
    right = [name for name in (one.geom(geom).name for geom in range(one.ngeom)) if "right_contact" in name]
    assert {one.geom(name).solref[0] for name in right} == {two.geom(name).solref[0] for name in right}
    stiffer, soft = (np.prod(model.geom("left_contact_0").solref) ** -2 for model in (one, two))
    assert soft < 0.7 * stiffer


def test_points_go_to_the_body_that_carried_the_ground(tmp_path: Path, one_step: None) -> None:
    """So that a force sensor between ankle and sole still feels the ground."""
    model = write_mjcf(tmp_path / "robot.xml")
    root = ET.parse(model).getroot()
    for body in list(root.iter("body")):
        side, _, part = body.get("name", "").partition("_")
        if part == "ankle":
            sole = ET.SubElement(body, "body", name=f"{side}_plate", pos="0.02 0 -0.05")
            for geom in [g for g in body.findall("geom") if "foot" in g.get("name", "")]:
                body.remove(geom)
                geom.set("pos", "-0.01 0 -0.04")
                sole.append(geom)
            body.remove(body.find(f"body[@name='{side}_heel']"))  # type: ignore[arg-type]
            body.remove(body.find(f"site[@name='{side}_ft']"))  # type: ignore[arg-type]
            ET.SubElement(sole, "site", name=f"{side}_ft")
    model.write_text(ET.tostring(root, encoding="unicode"))
    out = tmp_path / "out.xml"
    export(result(write_urdf(tmp_path / "b.urdf")), "mujoco-contact", out, model=model)
    made = mujoco.MjModel.from_xml_path(str(out))
    point = made.geom("left_contact_0")
    assert made.body(int(point.bodyid[0])).name == "left_plate"
    data = mujoco.MjData(made)
    mujoco.mj_kinematics(made, data)
    height = data.geom("left_contact_0").xpos[2] - data.body("left_ankle").xpos[2]
    assert -0.12 < height < -0.11 + 0.002


def test_what_the_model_cannot_do_is_said(tmp_path: Path) -> None:
    urdf = write_urdf(tmp_path / "b.urdf")
    model = write_mjcf(tmp_path / "robot.xml")
    model.write_text(model.read_text().replace("<worldbody>", '<option timestep="0.008"/><worldbody>', 1))
    notes = export(result(urdf), "mujoco-contact", tmp_path / "out.xml", model=model)
    assert "export_timestep" in {note.code for note in notes}
    beside = result(urdf)
    for entry in beside["robot_model"]["feet"].values():
        entry["bush"]["xyz"] = [0.3, 0.0, -0.08]
    with pytest.raises(
        ExportError,
        match=r"^the bush of 'left' does not stand over its sole \(valid: a bush between the sole's "
        r"edges\)$",
    ):
        export(beside, "mujoco-contact", tmp_path / "x.xml")


def test_a_richer_law_is_written_as_the_nearest_spring_and_damper(tmp_path: Path) -> None:
    made = result(write_urdf(tmp_path / "b.urdf"))
    row = copy.deepcopy(made["parameters"][2])
    made["parameters"].append(row | {"name": "slip_torque", "value": 5.0})
    nearest = {"stiffness": 530.0, "damping": 40.0}
    made["laws"] = [{"foot": "left", "axis": "pitch", "law": "elastoplastic", "linear_equivalent": nearest}]
    notes = export(made, "openhrp", tmp_path / "bush.conf")
    assert "LLEG_BUSH_PITCH,530,40" in (tmp_path / "bush.conf").read_text()
    assert any("slip_torque" in note.text for note in notes)


def test_an_offset_turns_the_points(tmp_path: Path) -> None:
    """Without a torque the sole, flat on the floor, stands at -offset/K to the ankle: the ankle leans by offset/K."""
    urdf = write_urdf(tmp_path / "b.urdf", rigid_legs=True)
    export(result(urdf), "mujoco-contact", tmp_path / "out.xml", with_offset=True)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    for geom in range(model.ngeom):
        if model.geom(geom).name.startswith("left_contact_"):
            model.geom_contype[geom] = model.geom_conaffinity[geom] = 0
    load = 0.5 * float(model.body_mass.sum()) * GRAVITY
    model.opt.gravity[:] = 0
    model.dof_damping[3:6] = 60.0
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    ankle, pelvis = model.body("right_ankle").id, model.body("pelvis").id
    for _ in range(2500):
        at = data.xpos[ankle] + data.xmat[ankle].reshape(3, 3) @ CENTRE
        data.xfrc_applied[pelvis, 2] = -load
        data.xfrc_applied[pelvis, 3:] = np.cross(at - data.xipos[pelvis], [0, 0, -load])
        mujoco.mj_step(model, data)
    k, _, offset = TRUTH["right"]["pitch"]
    assert 2 * data.qpos[5] == pytest.approx(offset / k, rel=0.05)


def test_a_slip_becomes_the_spring_and_damper_of_swings_of_one_size(tmp_path: Path) -> None:
    """Against the loop of an element that slips, followed sample by sample and projected onto cosine and sine."""
    element = Slip(5.0, 0.01)
    for swing in (0.004, 0.012, 0.05):
        phase = np.linspace(0, 6 * np.pi, 60001)
        angles = swing * np.cos(phase)
        torque, track = 0.0, []
        for turn in np.diff(angles, prepend=0.0):
            torque = float(np.clip(torque + element.stiffness * turn, -5.0, 5.0))
            track.append(torque)
        last = phase >= 4 * np.pi
        inward, outward = (
            2 * np.mean(np.array(track)[last] * wave(phase[last])) for wave in (np.cos, np.sin)
        )
        assert element.stiffness_at(swing) == pytest.approx(inward / swing, rel=2e-3)
        assert element.damping_at(swing) == pytest.approx(-outward / (swing * SWAY), rel=2e-3, abs=0.05)
    made = result(write_urdf(tmp_path / "b.urdf"))
    row = made["parameters"][2]
    made["parameters"] += [
        row | {"name": "slip_torque", "value": 5.0},
        row | {"name": "slip_angle", "value": 0.01},
    ]
    notes = export(made, "openhrp", tmp_path / "bush.conf", swing=0.012)
    stiffness, damping = read_customizer(tmp_path / "bush.conf").joints["LLEG_BUSH_PITCH"]
    assert stiffness == pytest.approx(480 + element.stiffness_at(0.012), rel=1e-6)
    assert damping == pytest.approx(24.27 + element.damping_at(0.012), rel=1e-6)
    assert "export_swing" in {note.code for note in notes}
    for wrong in (0.0, -0.1, 3.0, float("nan")):
        with pytest.raises(ExportError, match="no angle of a foot"):
            export(made, "openhrp", tmp_path / "no.conf", swing=wrong)


def test_points_touch_what_the_shapes_touched(tmp_path: Path) -> None:
    """contype and conaffinity of a model whose feet meet the floor, and nothing of the robot."""
    urdf, model = write_urdf(tmp_path / "b.urdf"), write_mjcf(tmp_path / "model.xml")
    masks = 'contype="2" conaffinity="4"'
    model.write_text(model.read_text().replace('_foot" size', f'_foot" {masks} size'))
    export(result(urdf), "mujoco-contact", tmp_path / "out.xml", model=model)
    found = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    points = [geom for geom in range(found.ngeom) if "_contact_" in found.geom(geom).name]
    assert points
    assert {(int(found.geom_contype[geom]), int(found.geom_conaffinity[geom])) for geom in points} == {(2, 4)}
