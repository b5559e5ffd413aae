"""Feet on points whose slip the loop applies: pressed, pushed past the slip and let go; lifted, they forget."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import plantar
from export_robots import CENTRE, TRUTH, bush_rotation, result, write_urdf
from plantar.conventions import GRAVITY
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.contact.bush_on_sole import BushOnSole
from plantar.exporters.contact.hysteresis import _Foot
from plantar.exporters.spring import Slip

mujoco = pytest.importorskip("mujoco")

pytestmark = pytest.mark.usefixtures("contact_at_one_step")
TORQUE, ANGLE = 5.0, 0.01  # N·m, rad: where the element beside the spring slips
BESIDE = TORQUE / ANGLE


def slipping(urdf: Path, axis: str) -> dict[str, Any]:
    """The left foot slips about one axis; its z is not known."""
    made = result(urdf)
    made["parameters"] = [row for row in made["parameters"] if row["axis"] != "z"]
    for name, value in (("slip_torque", TORQUE), ("slip_angle", ANGLE)):
        row = {"foot": "left", "axis": axis, "name": name, "value": value, "std": 0.01 * value}
        made["parameters"].append(row | {"unit": "", "interval95": None, "verdict": "usable"})
    return made


class Pressed:
    """The robot, one piece, on its left foot under a load at the bush centre."""

    def __init__(self, file: Path, step: float) -> None:
        self.model = model = mujoco.MjModel.from_xml_path(str(file))
        for geom in range(model.ngeom):
            if model.geom(geom).name.startswith("right_contact_"):
                model.geom_contype[geom] = model.geom_conaffinity[geom] = 0
        self.weight = float(model.body_mass.sum()) * GRAVITY
        model.opt.gravity[:] = 0
        model.opt.timestep = step
        # It comes to rest soon, without yaw about the bush's own axes.
        model.dof_damping[3:6], model.dof_damping[5] = 60.0, 1e4
        self.data = mujoco.MjData(model)
        self.hysteresis = plantar.FootHysteresis(model)
        mujoco.mj_kinematics(model, self.data)
        self.ankle, self.pelvis = model.body("left_ankle").id, model.body("pelvis").id
        self.turn = self.data.xmat[self.ankle].reshape(3, 3) @ bush_rotation("left")

    def deflection(self, axis: str, torque: float, share: float = 0.8, seconds: float = 1.5) -> float:
        """The sole's angle to the ankle after a torque on the sole's side of the bush [rad], and so the reverse on the
        robot."""
        model, data = self.model, self.data
        place = {"roll": 0, "pitch": 1}[axis]
        for _ in range(round(seconds / model.opt.timestep)):
            mujoco.mj_step1(model, data)
            at = data.xpos[self.ankle] + data.xmat[self.ankle].reshape(3, 3) @ CENTRE
            x, y, _ = at - data.xipos[self.pelvis]
            data.xfrc_applied[self.pelvis, 2] = -(load := share * self.weight)
            data.xfrc_applied[self.pelvis, 3:] = load * np.array([-y, x, 0.0]) - torque * self.turn[:, place]
            self.hysteresis(model, data)
            mujoco.mj_step2(model, data)
        return float(-2 * np.array(data.qpos[4:7]) @ self.turn[:, place])


@pytest.mark.parametrize(("axis", "step"), [("pitch", 0.002), ("roll", 0.004)])
def test_a_foot_slips_as_its_law_says(axis: str, step: float, tmp_path: Path) -> None:
    """By statics of a spring beside an element that slips; with the pivot in the bush at every load the same."""
    urdf = write_urdf(tmp_path / "b.urdf", rigid_legs=True)
    out = tmp_path / "out.xml"
    notes = export(slipping(urdf, axis), "mujoco-contact", out, hysteresis=True, pivot="bush")
    assert {"export_hysteresis", "export_pivot"} <= {note.code for note in notes}
    assert "export_terms" not in {note.code for note in notes}, "nothing is left out"
    k, foot = TRUTH["left"][axis][0], Pressed(out, step)
    foot.deflection(axis, 0.0)
    foot.hysteresis.reset()  # of its landing
    foot.deflection(axis, 0.0)
    stuck, slipped, let_go, back = (foot.deflection(axis, torque) for torque in (4.0, 12.0, 0.0, -12.0))
    assert stuck == pytest.approx(4.0 / (k + BESIDE), rel=0.03), "below the slip both springs hold"
    assert slipped == pytest.approx((12.0 - TORQUE) / k, rel=0.03), (
        "above it the spring, less the slip's torque"
    )
    left = (BESIDE * slipped - TORQUE) / (k + BESIDE)
    assert let_go == pytest.approx(left, abs=0.03 * ANGLE), "let go, it does not come back"
    assert back == pytest.approx(-(12.0 - TORQUE) / k, rel=0.03)
    assert foot.deflection(axis, -12.0, share=1.1) == pytest.approx(back, rel=0.03), "under any load"
    eased = foot.deflection(axis, -7.0, share=0.5)  # a push of -12 would tip the sole under this load
    assert eased == pytest.approx(back + 5.0 / (k + BESIDE), rel=0.03)


def test_a_lifted_foot_forgets_and_gets_no_torque(tmp_path: Path) -> None:
    urdf = write_urdf(tmp_path / "b.urdf", rigid_legs=True)
    export(slipping(urdf, "pitch"), "mujoco-contact", tmp_path / "out.xml", hysteresis=True, pivot="bush")
    foot = Pressed(tmp_path / "out.xml", 0.002)
    foot.deflection("pitch", 12.0)
    sole = int(foot.model.site("left_contact_bush").bodyid[0])
    assert np.linalg.norm(foot.data.xfrc_applied[sole, 3:]) > 0.5 * TORQUE
    foot.data.qpos[2] += 0.1
    foot.data.qpos[3:7], foot.data.qvel[:] = (1, 0, 0, 0), 0
    mujoco.mj_step1(foot.model, foot.data)
    foot.hysteresis(foot.model, foot.data)
    assert not foot.data.xfrc_applied[sole].any()
    foot.data.qpos[2] -= 0.1
    assert abs(foot.deflection("pitch", 0.0)) < 0.1 * ANGLE, "it stands down as it stood first"


def test_the_torque_follows_the_ground_and_not_the_horizon(tmp_path: Path) -> None:
    """Robot and floor turned together by 0.2 rad: the same angles."""
    urdf = write_urdf(tmp_path / "b.urdf", rigid_legs=True)
    export(slipping(urdf, "pitch"), "mujoco-contact", tmp_path / "out.xml", hysteresis=True, pivot="bush")
    slope, lean, at = (
        np.zeros(4),
        np.array([1.0, 0.0, 0.0025, 0.0]),
        np.zeros(3),
    )  # 5 mrad of the robot to the floor
    mujoco.mju_axisAngle2Quat(slope, np.array([0.0, 1.0, 0.0]), 0.2)
    torques = []
    for floor in (np.array([1.0, 0.0, 0.0, 0.0]), slope):
        turned = f'name="floor" quat="{" ".join(str(part) for part in floor)}"'
        (tmp_path / "turned.xml").write_text(
            (tmp_path / "out.xml").read_text().replace('name="floor"', turned)
        )
        foot = Pressed(tmp_path / "turned.xml", 0.002)
        mujoco.mju_rotVecQuat(at, foot.data.qpos[:3] - np.array([0, 0, 0.035]), floor)
        foot.data.qpos[:3] = at
        mujoco.mju_mulQuat(foot.data.qpos[3:7], floor, lean)
        mujoco.mj_step1(foot.model, foot.data)
        foot.hysteresis(foot.model, foot.data)
        sole = int(foot.model.site("left_contact_bush").bodyid[0])
        mujoco.mju_rotVecQuat(at, foot.data.xfrc_applied[sole, 3:], floor * np.array([1, -1, -1, -1]))
        torques.append(at.copy())
    assert np.linalg.norm(torques[0]) > 0.5 * BESIDE * 0.005
    np.testing.assert_allclose(torques[1], torques[0], atol=1e-6)


def test_an_export_without_hysteresis_takes_it_off_again(tmp_path: Path) -> None:
    made = slipping(write_urdf(tmp_path / "b.urdf"), "roll")
    export(made, "mujoco-contact", tmp_path / "one.xml", hysteresis=True, pivot="bush")
    export(
        made,
        "mujoco-contact",
        tmp_path / "two.xml",
        model=tmp_path / "one.xml",
        hysteresis=True,
        pivot="bush",
    )
    plantar.FootHysteresis(mujoco.MjModel.from_xml_path(str(tmp_path / "two.xml")))
    export(made, "mujoco-contact", tmp_path / "three.xml", model=tmp_path / "two.xml", pivot="bush")
    with pytest.raises(
        ExportError,
        match=r"^the model carries no law of its feet \(valid: a file of --to mujoco-contact "
        r"--hysteresis\)$",
    ):
        plantar.FootHysteresis(mujoco.MjModel.from_xml_path(str(tmp_path / "three.xml")))


def test_rubber_that_does_not_slip_has_a_law_too(tmp_path: Path) -> None:
    """Turned beyond where points leave the ground, points and loop together hold with K, and with no more."""
    made, out = result(write_urdf(tmp_path / "b.urdf", rigid_legs=True)), tmp_path / "out.xml"
    notes = export(made, "mujoco-contact", out, hysteresis=True, pivot="bush", least_load=0.1)
    told = [note for note in notes if note.code == "export_hysteresis"]
    assert {note.severity for note in told} == {"info"}
    k, foot = TRUTH["left"]["pitch"][0], Pressed(out, 0.004)
    level = foot.deflection("pitch", 0.0)
    for torque in (15.0, -18.0):
        assert foot.deflection("pitch", torque) - level == pytest.approx(torque / k, rel=0.01)


def test_what_cannot_be_asked_for_is_said(tmp_path: Path) -> None:
    made, out = slipping(write_urdf(tmp_path / "b.urdf"), "roll"), tmp_path / "no"
    with pytest.raises(
        ExportError,
        match=r"^value 'bullet-contact': this target holds no hysteresis \(valid: mjcf, mujoco-contact, "
        r"or a swing\)$",
    ):
        export(made, "bullet-contact", out, hysteresis=True)
    with pytest.raises(
        ExportError,
        match=r"^value 'mjcf': this target takes no pivot and no least load \(valid: mujoco-contact\)$",
    ):
        export(made, "mjcf", out, pivot="bush")
    with pytest.raises(ExportError, match=r"^value 'heel': unknown pivot \(valid: ground, bush\)$"):
        export(made, "mujoco-contact", out, pivot="heel")
    for wrong in (0.0, 0.6, float("nan")):
        with pytest.raises(ExportError, match=r"valid: 0\.05 to 0\.5"):
            export(made, "mujoco-contact", out, least_load=wrong)
    with pytest.raises(
        ExportError,
        match=r"^a swing makes spring and damper of the slip that the hysteresis would keep \(valid: "
        r"one of the two\)$",
    ):
        export(made, "mujoco-contact", out, hysteresis=True, swing=0.01)
    assert not out.exists()


def test_both_axes_at_once_push_about_the_axes_that_the_sole_turns_about() -> None:
    """By hand: the ground's normal in the ankle's axes, the sole turned by pitch, then by roll; both stick."""
    pitch, roll = 0.3, -0.2
    turned = Rotation.from_euler("y", pitch)
    up = (turned * Rotation.from_euler("x", roll)).apply([0.0, 0.0, 1.0])
    corners = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    law = BushOnSole(np.array([1e3, 0.0, 0.0]), np.zeros(3), (Slip(5.0, 0.5), Slip(8.0, 0.4)), corners)
    force, torque = _Foot(0, 0, 0, 0.1, law).wrench(up, 0.02, 0.0, np.zeros(3))
    expected = turned.apply([5.0 / 0.5 * roll, 0.0, 0.0]) + [0.0, 8.0 / 0.4 * pitch, 0.0]
    assert force == pytest.approx(1e3 * 0.08), (
        "it is pressed in by what it stands lower than where it carries nothing"
    )
    np.testing.assert_allclose(torque, expected, atol=1e-12)
    assert law.yielded == pytest.approx([0.0, 0.0])


def test_a_foot_that_stands_flat_is_pushed_by_its_points_alone(tmp_path: Path) -> None:
    """Law and points have the same height under a load, also where edges touch before the sole's plane is down."""
    urdf = write_urdf(tmp_path / "b.urdf", rigid_legs=True)
    export(slipping(urdf, "pitch"), "mujoco-contact", tmp_path / "out.xml", hysteresis=True, pivot="bush")
    foot = Pressed(tmp_path / "out.xml", 0.002)
    foot.deflection("pitch", 0.0)
    sole = int(foot.model.site("left_contact_bush").bodyid[0])
    assert abs(foot.data.xfrc_applied[sole, 2]) < 0.05 * foot.weight
