"""A bush that slips, in MuJoCo: loaded, pushed past the slip and let go, its angles are those of the law."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_robots import TRUTH, bush_rotation, result, write_mjcf, write_urdf
from plantar.exporters import export

mujoco = pytest.importorskip("mujoco")

TORQUE, ANGLE = 5.0, 0.01  # N·m, rad: where the element beside the spring slips
K = TRUTH["left"]["pitch"][0]
BESIDE = TORQUE / ANGLE


def slipping(urdf: Path) -> dict[str, Any]:
    """The left foot's pitch slips, all other axes are springs and dampers."""
    made = result(urdf)
    for name, value in (("slip_torque", TORQUE), ("slip_angle", ANGLE)):
        row = {"foot": "left", "axis": "pitch", "name": name, "value": value, "std": 0.01 * value}
        made["parameters"].append(row | {"unit": "", "interval95": None, "verdict": "usable"})
    return made


def angles(path: Path, torques: tuple[float, ...], step: float) -> list[float]:
    """Where the left bush's pitch stands after two seconds of each torque in turn [rad]; all else is held."""
    model = mujoco.MjModel.from_xml_path(str(path))
    for joint in range(model.njnt):
        if "PITCH" not in model.joint(joint).name:
            first = model.jnt_dofadr[joint]
            model.dof_armature[first : first + (6 if model.jnt_type[joint] == 0 else 1)] = 1e9
    model.opt.tolerance = 0.0  # it is scaled with the inertia that holds the robot
    model.opt.gravity[:] = 0
    model.opt.timestep = step
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    axis = data.body("left_ankle").xmat.reshape(3, 3) @ bush_rotation("left")[:, 1]
    found = []
    for torque in torques:
        data.xfrc_applied[model.body("left_bush_sole").id, 3:] = torque * axis
        for _ in range(round(2.0 / step)):
            mujoco.mj_step(model, data)
        found.append(float(data.joint("LLEG_BUSH_PITCH").qpos[0]))
    return found


@pytest.mark.parametrize("step", [0.0005, 0.004])
def test_a_bush_slips_in_mujoco_as_its_law_says(step: float, tmp_path: Path) -> None:
    out = tmp_path / "out.xml"
    notes = export(slipping(write_urdf(tmp_path / "biped.urdf")), "mjcf", out)
    assert "export_terms" not in {note.code for note in notes}, "nothing is left out"
    stuck, slipped, let_go, back = angles(out, (4.0, 12.0, 0.0, -12.0), step)
    assert stuck == pytest.approx(4.0 / (K + BESIDE), rel=0.01), "below the slip both springs hold"
    assert slipped == pytest.approx((12.0 - TORQUE) / K, rel=0.01), (
        "above it the spring, less the slip's torque"
    )
    left = (BESIDE * slipped - TORQUE) / (K + BESIDE)
    assert BESIDE * (slipped - left) < 2 * TORQUE, "it comes back without slipping"
    assert let_go == pytest.approx(left, abs=0.02 * ANGLE), "let go, it does not come back"
    assert back == pytest.approx(-(12.0 - TORQUE) / K, rel=0.01)


def test_a_models_own_defaults_leave_the_slip_as_it_is(tmp_path: Path) -> None:
    model = write_mjcf(tmp_path / "robot.xml")
    own = '<tendon springlength="0.1" damping="9" frictionloss="9" limited="true" range="-1e-3 1e-3"/>'
    joint = (
        '<joint ref="0.1" damping="9" stiffness="9" limited="true" range="-1e-3 1e-3" springdamper="1 1"/>'
    )
    text = model.read_text().replace("<worldbody>", f"<default>{own}{joint}</default><worldbody>", 1)
    assert "<default>" in text
    model.write_text(text)
    export(slipping(write_urdf(tmp_path / "biped.urdf")), "mjcf", tmp_path / "out.xml", model=model)
    stuck, slipped = angles(tmp_path / "out.xml", (4.0, 12.0), 0.001)
    assert stuck == pytest.approx(4.0 / (K + BESIDE), rel=0.01)
    assert slipped == pytest.approx((12.0 - TORQUE) / K, rel=0.01)


def test_a_result_without_slip_takes_it_off_again(tmp_path: Path) -> None:
    urdf, model = write_urdf(tmp_path / "biped.urdf"), write_mjcf(tmp_path / "robot.xml")
    export(slipping(urdf), "mjcf", tmp_path / "one.xml", model=model)
    export(result(urdf), "mjcf", tmp_path / "two.xml", model=tmp_path / "one.xml")
    assert angles(tmp_path / "two.xml", (20.0,), 0.001)[0] == pytest.approx(20.0 / K, rel=0.002)
    export(slipping(urdf), "mjcf", tmp_path / "three.xml", model=tmp_path / "two.xml")
    assert angles(tmp_path / "three.xml", (20.0,), 0.001)[0] == pytest.approx((20.0 - TORQUE) / K, rel=0.01)
    key = mujoco.MjModel.from_xml_path(str(tmp_path / "one.xml")).key("bent").qpos
    assert len(key) == 17, "what was there, five joints of the bushes and the one that slips"
    assert np.count_nonzero(key[7:]) == 4, "the robot stands as it did"


def test_a_target_without_hysteresis_says_so(tmp_path: Path) -> None:
    notes = export(slipping(write_urdf(tmp_path / "biped.urdf")), "sdf", tmp_path / "out.sdf")
    assert "export_terms" in {note.code for note in notes}
