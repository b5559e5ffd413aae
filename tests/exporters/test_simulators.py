"""Exports proven: loaded in MuJoCo and Pinocchio, a known torque on the foot gives K and C back.

The torque is set up from the robot's geometry in `export_robots`, not from what the exporter wrote; K is the
torque over the settled angle, C comes from the decay after release.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.integrate import solve_ivp

from export_robots import CENTRE, TRUTH, bush_rotation, result, write_mjcf, write_urdf
from plantar.conventions import rotation_from_rpy
from plantar.exporters import export
from pushed_foot import DIRECTION, LOAD, check, joint_name

# --- MuJoCo -----------------------------------------------------------------------------------------------


@pytest.fixture(params=["mjcf", "urdf"])
def mujoco_model(request: pytest.FixtureRequest, tmp_path: Path):  # type: ignore[no-untyped-def]
    """A user's MJCF extended, and a URDF turned into MJCF; written to another directory than the model's."""
    mujoco = pytest.importorskip("mujoco")
    urdf = write_urdf(tmp_path / "biped.urdf")
    model = write_mjcf(tmp_path / "robot.xml") if request.param == "mjcf" else None
    out = tmp_path / "elsewhere" / "out.xml"
    notes = export(result(urdf), "mjcf", out, model=model)
    assert not [note for note in notes if note.severity == "warning"], notes
    return mujoco.MjModel.from_xml_path(str(out)), request.param


def _hold(model) -> None:  # type: ignore[no-untyped-def]
    """Robot and gravity held still: only the bushes move."""
    import mujoco

    for joint in range(model.njnt):
        if "BUSH" not in model.joint(joint).name:
            first = model.jnt_dofadr[joint]
            model.dof_armature[first : first + (6 if model.jnt_type[joint] == 0 else 1)] = 1e9
    model.opt.gravity[:] = 0
    model.opt.timestep = 1e-4
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS


@pytest.mark.parametrize("axis", ["pitch", "roll", "z"])
def test_mujoco_gives_stiffness_and_damping_back(mujoco_model, axis: str) -> None:  # type: ignore[no-untyped-def]
    import mujoco

    model, _ = mujoco_model
    _hold(model)
    model.opt.timestep = 2e-5 if axis == "z" else 1e-4  # C comes out K·timestep/2 too low
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    feet = [foot for foot in TRUTH if axis in TRUTH[foot]]
    for foot in feet:
        turn = data.body(f"{foot}_ankle").xmat.reshape(3, 3) @ bush_rotation(foot)
        direction = LOAD[axis] * turn[:, DIRECTION[axis]]
        sole = model.body(f"{foot}_bush_sole").id
        # A force at the sole body's centre of mass, which the exporter puts at the bush, or a pure torque.
        data.xfrc_applied[sole] = (
            np.r_[direction, np.zeros(3)] if axis == "z" else np.r_[np.zeros(3), direction]
        )
    for _ in range(10000):
        mujoco.mj_step(model, data)
    settled = {foot: data.joint(joint_name(foot, axis)).qpos[0] for foot in feet}
    data.xfrc_applied[:] = 0
    times, tracks = [], {foot: [] for foot in feet}
    for step in range(8000):
        times.append(step * model.opt.timestep)
        for foot in feet:
            tracks[foot].append(data.joint(joint_name(foot, axis)).qpos[0])
        mujoco.mj_step(model, data)
    for foot in feet:
        check(foot, axis, LOAD[axis], settled[foot], np.array(times), np.array(tracks[foot]))


def test_mujoco_deflects_as_the_conventions_say(mujoco_model) -> None:  # type: ignore[no-untyped-def]
    """R_ankle_sole = Ry(pitch) Rx(roll) about the bush centre, in the bush's axes."""
    import mujoco

    model, _ = mujoco_model
    data = mujoco.MjData(model)
    for foot in TRUTH:
        data.joint(joint_name(foot, "pitch")).qpos[0] = 0.2
        data.joint(joint_name(foot, "roll")).qpos[0] = -0.3
    mujoco.mj_kinematics(model, data)
    for foot in TRUTH:
        ankle, sole = data.body(f"{foot}_ankle"), data.body(f"{foot}_bush_sole")
        seen = ankle.xmat.reshape(3, 3).T @ sole.xmat.reshape(3, 3)
        bush = bush_rotation(foot)
        wanted = rotation_from_rpy(np.array([0, 0.2, 0])) @ rotation_from_rpy(np.array([-0.3, 0, 0]))
        np.testing.assert_allclose(bush.T @ seen @ bush, wanted, atol=1e-9)
        centre = [body.xpos + body.xmat.reshape(3, 3) @ CENTRE for body in (ankle, sole)]
        np.testing.assert_allclose(centre[0], centre[1], atol=1e-12)


def test_mujoco_keeps_the_robot_and_moves_the_ground_shapes(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    source = write_mjcf(tmp_path / "robot.xml")
    export(
        result(write_urdf(tmp_path / "b.urdf")), "mjcf", tmp_path / "out.xml", model=source, with_offset=True
    )
    before, after = (mujoco.MjModel.from_xml_path(str(p)) for p in (source, tmp_path / "out.xml"))
    assert after.body_mass.sum() == pytest.approx(before.body_mass.sum(), rel=1e-9)
    assert after.nq == before.nq + 5
    owner = {after.geom(g).name: after.body(after.geom_bodyid[g]).name for g in range(after.ngeom)}
    assert owner["left_foot"] == "left_bush_sole"
    assert owner["left_cover"] == "left_ankle"
    assert after.body(after.body("left_heel").parentid[0]).name == "left_bush_sole"
    site = {after.site(s).name: after.body(after.site_bodyid[s]).name for s in range(after.nsite)}
    assert site["left_sole"] == "left_bush_sole"
    assert site["left_ft"] == "left_ankle", "a force sensor stays above the bush"
    # The keyframe: old joints keep their values, new ones stand at 0.
    key = after.key_qpos[0]
    names = {after.joint(j).name: key[after.jnt_qposadr[j]] for j in range(after.njnt)}
    assert [names[f"{s}_{j}"] for s in ("left", "right") for j in ("hip", "ankle_pitch")] == [
        0.1,
        0.2,
        0.3,
        0.4,
    ]
    assert all(value == 0 for name, value in names.items() if "BUSH" in name)
    # Offsets: degrees are this model's default; the spring rests at -offset / K.
    rest = after.qpos_spring[after.joint("LLEG_BUSH_PITCH").qposadr[0]]
    assert rest == pytest.approx(-5.66 / 480, rel=1e-6)
    # No traps from the user's classes.
    dof = after.joint("LLEG_BUSH_ROLL").dofadr[0]
    assert (after.dof_damping[dof], after.dof_frictionloss[dof]) == (28.15, 0)
    # A sole that MuJoCo's contacts turn as far as they should: see `_add_joint`.
    assert after.dof_armature[dof] == pytest.approx(after.opt.timestep * 28.15)
    assert not after.jnt_limited[after.joint("LLEG_BUSH_ROLL").id]
    data = mujoco.MjData(after)
    for pose in range(40):  # no contact inside a leg, however the feet deflect
        mujoco.mj_resetData(after, data)
        data.qpos[2] = 2.0
        rng = np.random.default_rng(pose)
        for j in range(1, after.njnt):
            data.qpos[after.jnt_qposadr[j]] = rng.uniform(-0.1, 0.1)
        mujoco.mj_forward(after, data)
        pairs = {tuple(after.body(after.geom_bodyid[g]).name for g in c.geom) for c in data.contact}
        assert not [p for p in pairs if p[0].split("_")[0] == p[1].split("_")[0]], pairs


def test_a_sole_that_is_a_body_of_its_own_goes_along_wherever_its_frame_stands(tmp_path: Path) -> None:
    """Its frame in the bush centre: left at the ankle, it would carry the ground's force past the bush."""
    mujoco = pytest.importorskip("mujoco")
    source = write_mjcf(tmp_path / "robot.xml")
    root = ET.parse(source).getroot()
    ankle = next(body for body in root.iter("body") if body.get("name") == "left_ankle")
    foot = next(geom for geom in ankle.findall("geom") if geom.get("name") == "left_foot")
    ankle.remove(foot)
    foot.set("pos", "0 0 -0.01")
    sole = ET.SubElement(ankle, "body", name="left_plate", pos=" ".join(str(value) for value in CENTRE))
    sole.append(foot)
    source.write_text(ET.tostring(root, encoding="unicode"))
    export(result(write_urdf(tmp_path / "b.urdf")), "mjcf", tmp_path / "out.xml", model=source)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    assert model.body(model.body("left_plate").parentid[0]).name == "left_bush_sole"


def test_a_urdfs_contact_is_stiff_and_said_to_be(tmp_path: Path) -> None:
    """Time constant of every contact of a standing robot, shapes of the URDF or plates, and what the note says."""
    mujoco = pytest.importorskip("mujoco")
    urdf = write_urdf(tmp_path / "b.urdf")
    for text in (urdf.read_text(), re.sub(r'<collision name="foot">.*?</collision>', "", urdf.read_text())):
        urdf.write_text(text)
        notes = export(result(urdf), "mjcf", tmp_path / "o.xml")
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "o.xml"))
        data = mujoco.MjData(model)
        for _ in range(50):
            mujoco.mj_step(model, data)
        assert data.ncon > 0
        assert {float(contact.solref[0]) for contact in data.contact} == {0.004}
        assert any("contact of 4 ms" in note.text for note in notes)
    assert any("200 x 120 mm" in note.text for note in notes if note.code == "export_plate")
    softer = export(result(urdf), "mjcf", tmp_path / "own.xml", model=write_mjcf(tmp_path / "m.xml"))
    assert any("as soft as the model has it" in note.text for note in softer)


def test_mujoco_export_onto_its_own_export_updates_the_values(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    made = result(write_urdf(tmp_path / "b.urdf"))
    export(made, "mjcf", tmp_path / "one.xml")
    made["parameters"][2]["value"] = 300.0
    export(made, "mjcf", tmp_path / "two.xml", model=tmp_path / "one.xml")
    one, two = (mujoco.MjModel.from_xml_path(str(tmp_path / f"{n}.xml")) for n in ("one", "two"))
    assert one.njnt == two.njnt
    assert two.jnt_stiffness[two.joint("LLEG_BUSH_PITCH").id] == 300


# --- Pinocchio --------------------------------------------------------------------------------------------


def test_pinocchio_gives_stiffness_and_damping_back(tmp_path: Path) -> None:
    """The URDF's joints and dampers by Pinocchio, its springs from Gazebo's tags, under external wrenches."""
    urdf = write_urdf(tmp_path / "rigid.urdf", rigid_legs=True)
    export(result(urdf), "urdf", tmp_path / "out.urdf", with_offset=True)
    model = pin.buildModelFromUrdf(str(tmp_path / "out.urdf"))
    model.gravity.linear = np.zeros(3)
    data = model.createData()
    tags = {e.get("reference"): e for e in ET.parse(tmp_path / "out.urdf").getroot().findall("gazebo")}
    spring, rest = (np.array([float(tags[name].findtext(tag)) for name in list(model.names)[1:]])
                    for tag in ("springStiffness", "springReference"))  # fmt: skip
    damping = np.asarray(model.damping)
    for axis in ("pitch", "roll", "z"):
        for foot in (foot for foot in TRUTH if axis in TRUTH[foot]):
            joint = model.getJointId(joint_name(foot, axis))
            frame = model.getFrameId(f"{foot}_bush_sole")
            pin.framesForwardKinematics(model, data, pin.neutral(model))
            turn = data.oMf[model.getFrameId(f"{foot}_ankle")].rotation @ bush_rotation(foot)
            linear, angular = np.zeros(3), np.zeros(3)
            (linear if axis == "z" else angular)[:] = LOAD[axis] * turn[:, DIRECTION[axis]]

            def motion(
                t: float,
                state: np.ndarray,
                frame: int = frame,
                f: np.ndarray = linear,
                n: np.ndarray = angular,
            ):  # type: ignore[no-untyped-def]
                q, v = np.split(state, 2)
                pin.forwardKinematics(model, data, q)
                pin.updateFramePlacements(model, data)
                forces = [pin.Force.Zero() for _ in range(model.njoints)]
                if t < 2.0:
                    place = data.oMf[frame]
                    at_frame = pin.Force(place.rotation.T @ f, place.rotation.T @ n)
                    holder = model.frames[frame]
                    forces[holder.parentJoint] = holder.placement.act(at_frame)
                torque = -spring * (q - rest) - damping * v
                return np.r_[v, pin.aba(model, data, q, v, torque, forces)]

            times = np.linspace(2.0, 2.8, 1600)
            start = np.r_[rest, np.zeros(model.nv)]
            loaded = solve_ivp(motion, (0, 1.9999), start, method="Radau", rtol=1e-6, atol=1e-9)
            freed = solve_ivp(motion, (2.0, 2.8), loaded.y[:, -1], "Radau", times, rtol=1e-7, atol=1e-10)
            row = model.joints[joint].idx_q
            check(foot, axis, LOAD[axis], loaded.y[row, -1], times - 2, freed.y[row], rest[row])
            assert rest[row] == pytest.approx(-TRUTH[foot][axis][2] / TRUTH[foot][axis][0], rel=1e-9)
