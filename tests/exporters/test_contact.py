"""Feet on points: what they turn with alone in MuJoCo, and in the file that a user gets.

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
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.alone import INERTIA_TIME, Measured, contact_attributes, measured
from plantar.exporters.contact.fit import LOADS, STEPS, fitted
from plantar.exporters.contact.points import Point, Sides, points_for, sides_of
from plantar.exporters.job import LEAST_LOAD as EDGES
from plantar.exporters.openhrp import read_customizer
from plantar.exporters.spring import (
    Slip,
    Spring,
)

SWAY = 3.0

mujoco = pytest.importorskip("mujoco")
ROTATIONS: tuple[Axis, ...] = ("pitch", "roll")
FEET: dict[str, tuple[dict[Axis, tuple[float, float]], Sides, float, float]] = {
    # K and C by axis, the sole, its depth below the bush, the robot's mass
    "on rubber": ({"pitch": (480, 24), "roll": (352, 28)}, Sides(0.11, 0.11, 0.07, 0.07), 0.02, 57),
    "large, ankle far back": ({"pitch": (2600, 40), "roll": (1500, 50)}, Sides(0.15, 0.07, 0.06, 0.06), 0.1, 95),
    "stiff in roll": ({"pitch": (300, 12), "roll": (900, 9), "z": (2e5, 300)}, Sides(0.1, 0.08, 0.05, 0.06), 0.03, 40),
}  # fmt: skip


def bush(axes: dict[Axis, tuple[float, float]], sole: Sides, depth: float) -> FootBush:
    springs = tuple(Spring(axis, *axes[axis], 0.0) for axis in ("z", "pitch", "roll") if axis in axes)  # type: ignore[index]
    outline = [(x, y, -depth) for x, y in ((sole.front, sole.left), (sole.front, -sole.right),
                                           (-sole.back, -sole.right), (-sole.back, sole.left))]  # fmt: skip
    return FootBush("left", "ankle", springs, np.zeros(3), np.eye(3), np.array(outline))


@pytest.mark.parametrize("name", FEET)
def test_points_have_the_sums_that_they_were_asked_for_and_balance_about_the_bush(name: str) -> None:
    axes, sole, depth, mass = FEET[name]
    stiffness, damping = ({axis: pair[place] for axis, pair in axes.items()} for place in (0, 1))
    foot = points_for(stiffness, damping, sole, depth, mass * GRAVITY, EDGES)
    assert 4 <= len(foot.points) <= 9
    assert all(point.stiffness > 0 and point.damping > 0 for point in foot.points)
    for axis in ROTATIONS:
        assert foot.turning(axis) == pytest.approx(axes[axis])
    for moment in (lambda p: p.x, lambda p: p.y, lambda p: p.x * p.y):
        assert sum(moment(p) * p.stiffness for p in foot.points) == pytest.approx(0, abs=1e-6)
        assert sum(moment(p) * p.damping for p in foot.points) == pytest.approx(0, abs=1e-6)
    if "z" in axes:
        assert foot.vertical[0] == pytest.approx(axes["z"][0])
    # The edges carry their part before the middle touches, and the sinking goes on without a step.
    carried = EDGES * mass * GRAVITY
    assert foot.sink(carried) == pytest.approx(0, abs=1e-9)
    assert foot.sink(0.5 * carried) == pytest.approx(-0.5 * max(point.lower for point in foot.points))


def test_one_axis_alone_stands_on_corners() -> None:
    foot = points_for({"pitch": 400}, {"pitch": 20}, Sides(0.1, 0.1, 0.05, 0.05), 0.02, 500, EDGES)
    assert foot.turning("pitch") == pytest.approx((400, 20))
    assert sum(point.lower > 0 for point in foot.points) == 4


def test_a_sole_is_taken_as_a_rectangle_of_its_area() -> None:
    sole = bush(FEET["large, ankle far back"][0], FEET["large, ankle far back"][1], 0.1)
    assert vars(sides_of(sole)) == pytest.approx(vars(FEET["large, ankle far back"][1]))
    outline = 0.1 * np.array([(np.cos(a), np.sin(a), -1) for a in np.linspace(0, 2 * np.pi, 200)])
    round_sole = FootBush("left", "ankle", (), np.zeros(3), np.eye(3), outline)
    sides = sides_of(round_sole)
    assert (sides.front + sides.back) * (sides.left + sides.right) == pytest.approx(np.pi * 0.01, rel=2e-3)


@pytest.mark.parametrize("axis", ROTATIONS)
def test_the_load_takes_its_height_off_the_stiffness(axis: Axis) -> None:
    """About the bush centre the ground's push leans with the sole: K = Σ k x² - load x depth, by statics."""
    axes, sole, depth, mass = FEET["on rubber"]
    stiffness, damping = ({axis: pair[place] for axis, pair in axes.items()} for place in (0, 1))
    foot = points_for(stiffness, damping, sole, depth, mass * GRAVITY, EDGES)
    for load in (250.0, 600.0):
        seen = measured(foot, axis, load, 0.001)
        assert seen.stiffness == pytest.approx(axes[axis][0] - load * depth, rel=5e-3)
        assert seen.damping == pytest.approx(axes[axis][1], rel=0.03)  # soles creep a little, which damps too


@pytest.mark.slow
@pytest.mark.parametrize("name", FEET)
def test_a_fitted_foot_gives_k_and_c_back_at_every_load_and_step(name: str) -> None:
    axes, sole, depth, mass = FEET[name]
    found = fitted(bush(axes, sole, depth), mass * GRAVITY)
    for check in found.checks:
        k, c = axes[check.axis]
        assert check.steps == STEPS
        for load in LOADS:
            for step in STEPS:
                seen = measured(found.foot, check.axis, load * mass * GRAVITY, step)
                assert seen.stiffness == pytest.approx(k, rel=0.05)
                assert seen.damping == pytest.approx(c, rel=0.15)
        # As far as it is said to hold, it holds; where all points have left the ground but the far ones, it does not.
        least = LOADS[0] * mass * GRAVITY
        share = check.angle / found.foot.touching_angle(check.axis, least)
        assert measured(found.foot, check.axis, least, 0.001, share).stiffness == pytest.approx(k, rel=0.05)
        beyond = measured(found.foot, check.axis, least, 0.001, 1.4)
        assert not beyond.stiffness > 0.95 * k


def test_a_step_that_does_not_hold_is_not_said_to() -> None:
    foot = fitted(bush(*FEET["on rubber"][:3]), 57 * GRAVITY).foot
    seen = measured(foot, "roll", 280, 0.02)
    assert seen == pytest.approx(Measured(np.nan, np.nan), nan_ok=True) or abs(seen.damping / 28 - 1) > 0.15


# --- The exported file ------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("axis", ROTATIONS)
@pytest.mark.parametrize("foot", TRUTH)
@pytest.mark.parametrize("share", [0.5, 1.0])
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
    place = {"roll": 0, "pitch": 1}[axis]

    def pushed(torque: float) -> float:
        """Turn about the bush's axis after one step under a load straight down at the bush centre and a torque."""
        turn = data.xmat[ankle].reshape(3, 3)
        bush_axis = turn @ bush_rotation(foot)[:, place]
        at = data.xpos[ankle] + turn @ CENTRE
        force = np.array([0.0, 0.0, -share * weight])
        data.xfrc_applied[pelvis, :3] = force
        data.xfrc_applied[pelvis, 3:] = np.cross(at - data.xipos[pelvis], force) + torque * bush_axis
        mujoco.mj_step(model, data)
        return float(2 * np.array(data.qpos[4:7]) @ bush_axis)

    step, torque = model.opt.timestep, 3.0
    # The robot's own inertia swings on the foot: friction of its own lets it come to rest, and is taken off C again.
    swing = 6.0
    model.dof_damping[3:6] = 60.0
    times = np.arange(round(5.0 / step)) * step  # it is at rest in its swing after some tenths of a second
    angles = np.array([pushed(torque * np.cos(swing * time)) for time in times])
    last = times > times[-1] - 3 * 2 * np.pi / swing
    late = times[last] + step
    basis = np.column_stack([np.cos(swing * late), -np.sin(swing * late), np.ones(late.size)])
    real, imaginary, _ = np.linalg.lstsq(basis, angles[last], rcond=None)[0]
    response = torque / complex(real, imaginary)
    assert response.imag / swing - 60.0 == pytest.approx(c, rel=0.15)
    ends = []
    for sign in (1, -1):
        mujoco.mj_resetData(model, data)
        mujoco.mj_kinematics(model, data)
        ends.append(np.mean([pushed(sign * torque) for _ in range(round(2.5 / step))][-200:]))
    assert 2 * torque / (ends[0] - ends[1]) == pytest.approx(k, rel=0.05)


@pytest.mark.parametrize("step", STEPS)
def test_the_robot_stays_and_only_the_points_touch(exported: tuple[Path, Any], step: float) -> None:
    model = mujoco.MjModel.from_xml_path(str(exported[0]))
    model.opt.timestep = step
    assert model.nv == 6, "no joint was added"
    names = {model.geom(geom).name: geom for geom in range(model.ngeom)}
    for side in TRUTH:
        points = [geom for name, geom in names.items() if name.startswith(f"{side}_contact_")]
        assert 4 <= len(points) <= 9
        assert model.geom_contype[points].all()
    data = mujoco.MjData(model)
    for _ in range(round(3 / step)):
        mujoco.mj_step(model, data)
    touching = {model.geom(geom).name for contact in data.contact for geom in contact.geom} - {"floor"}
    assert touching == {name for name in names if "_contact_" in name}
    # It stands where it stood, on the points' height: within what the feet sink and the edges reach.
    weight = float(model.body_mass.sum()) * GRAVITY
    force = sum(data.efc_force[contact.efc_address] for contact in data.contact)
    assert force == pytest.approx(weight, rel=0.02)
    # The left foot's z is softer than points that turn like it: said, and nothing else is.
    assert {note.code for note in exported[1] if note.severity == "warning"} == {"export_vertical"}
    assert {"export_contact", "export_vertical", "export_friction"} <= {note.code for note in exported[1]}


def test_a_second_export_takes_the_place_of_the_first(tmp_path: Path) -> None:
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


@pytest.mark.parametrize("damping", [0.0, 300.0, 3e5])
def test_a_point_pushes_with_its_spring_and_damper_either_way_it_is_written(damping: float) -> None:
    """With a damper it has a time constant, which engines beside MuJoCo read; without one stiffness and damping."""
    written = contact_attributes(Point(0.0, 0.0, 2e4, damping), 0.5)
    assert written["solref"].startswith("-") == (damping == 0)
    assert damping == 0 or float(written["solref"].split()[0]) >= 2 * max(STEPS)
    inertia = max(INERTIA_TIME * damping, 0.5 * INERTIA_TIME**2 * 2e4)
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option cone="elliptic" gravity="0 0 0"/><worldbody><geom type="plane" size="1 1 1"/><body>'
        '<joint type="slide" axis="0 0 1"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>'
        '<geom type="sphere" size="0.002" pos="0 0 0.001" mass="0" priority="1" '
        + " ".join(f'{key}="{value}"' for key, value in written.items())
        + "/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    data.qvel[0] = -0.002  # 1 mm in the ground, and sinking
    mujoco.mj_forward(model, data)
    # (m + inertia) a = k r - c v
    assert (2 + inertia) * data.qacc[0] == pytest.approx(2e4 * 0.001 + damping * 0.002, rel=1e-6)


def test_points_go_to_the_body_that_carried_the_ground(tmp_path: Path) -> None:
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
    with pytest.raises(ExportError, match="does not stand over its sole"):
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
