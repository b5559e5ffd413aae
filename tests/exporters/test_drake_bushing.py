"""Drake's bushing as it is written: stiffness and damping by axis, and a frame that is tilted by the springs' rests."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from export_robots import TRUTH, result, write_urdf
from plantar.exporters import export
from plantar.exporters.sdf.drake import tag
from plantar.exporters.sdf.tree import pose_of

FEET = {"left": "LLEG", "right": "RLEG"}


def exported(folder: Path, *, with_offset: bool) -> ET.Element:
    out = folder / f"{with_offset}.sdf"
    export(result(write_urdf(folder / "rigid.urdf")), "drake", out, with_offset=with_offset)
    model = ET.parse(out).getroot().find("model")
    assert model is not None
    return model


def turn_of(model: ET.Element, foot: str) -> np.ndarray:
    (frame,) = [one for one in model.findall("frame") if one.get("name") == f"{foot}_bushing_A"]
    return pose_of(frame)[:3, :3]


@pytest.mark.parametrize("foot", FEET)
def test_each_axis_has_its_own_spring(tmp_path: Path, foot: str) -> None:
    """About x what is identified of roll, about y what is of pitch; an axis without a spring has none."""
    model = exported(tmp_path, with_offset=False)
    (bushing,) = [
        one
        for one in model.findall(tag("linear_bushing_rpy"))
        if one.findtext(tag("bushing_frameA"), "").strip() == f"{foot}_bushing_A"
    ]
    axes = TRUTH[foot]
    for place, kind in enumerate(("stiffness", "damping")):
        values = [float(part) for part in bushing.findtext(tag(f"bushing_torque_{kind}"), "").split()]
        assert values == pytest.approx([axes["roll"][place], axes["pitch"][place], 0.0])
        values = [float(part) for part in bushing.findtext(tag(f"bushing_force_{kind}"), "").split()]
        assert values == pytest.approx([0.0, 0.0, axes["z"][place] if "z" in axes else 0.0])


@pytest.mark.parametrize("foot", FEET)
def test_what_the_bush_holds_does_not_touch_what_holds_it(tmp_path: Path, foot: str) -> None:
    model = exported(tmp_path, with_offset=False)
    groups = {one.get("name"): one for one in model.findall(tag("collision_filter_group"))}
    group = groups[f"{foot}_bush_filter"]
    assert {f"{foot}_ankle", f"{foot}_shin"} < {one.text for one in group.findall(tag("member"))}
    assert group.findtext(tag("ignored_collision_filter_group")) == f"{foot}_bush_filter"


@pytest.mark.parametrize("with_offset", [False, True])
def test_a_tilted_frame_is_told_of(tmp_path: Path, with_offset: bool) -> None:
    urdf = write_urdf(tmp_path / "rigid.urdf")
    notes = export(result(urdf), "drake", tmp_path / "out.sdf", with_offset=with_offset)
    assert any("its frame on the ankle is tilted" in note.text for note in notes) == with_offset


@pytest.mark.parametrize("foot", FEET)
def test_offsets_tilt_the_frame_about_their_own_axes(tmp_path: Path, foot: str) -> None:
    """To where the spring's torque is nothing: -offset over stiffness."""
    plain, tilted = (turn_of(exported(tmp_path, with_offset=each), foot) for each in (False, True))
    turn = plain.T @ tilted
    for axis, angle in (("roll", turn[2, 1]), ("pitch", turn[0, 2])):
        stiffness, _, offset = TRUTH[foot][axis]
        assert angle == pytest.approx(-offset / stiffness, rel=1e-3, abs=1e-9)


def test_the_bushes_joints_are_no_actuators(tmp_path: Path) -> None:
    """Drake gives one to every joint whose effort is not 0: a controller's torques would not fit the plant any more."""
    joints = {joint.get("name"): joint for joint in exported(tmp_path, with_offset=False).findall("joint")}
    efforts = {name: joint.findtext("axis/limit/effort") for name, joint in joints.items()}
    driven = {name for name, joint in joints.items() if joint.get("type") != "fixed" and efforts[name] != "0"}
    assert driven == {"left_hip", "left_ankle_pitch", "right_hip", "right_ankle_pitch"}
