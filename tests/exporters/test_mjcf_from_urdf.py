"""What MuJoCo's export says of a URDF that MuJoCo does not take, and of a bush that is quick for the time step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from export_robots import result, write_urdf
from plantar.exporters import export

AS_DRAWN = 'ixx="0.3" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.3"'
OF_NO_BODY = 'ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.4"'


def test_moments_that_no_body_has_become_their_mean_and_that_is_said(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    urdf, out = write_urdf(tmp_path / "b.urdf"), tmp_path / "o.xml"
    whole = [note.code for note in export(result(urdf), "mjcf", out)]
    assert "export_inertia" not in whole
    urdf.write_text(urdf.read_text().replace(AS_DRAWN, OF_NO_BODY))
    notes = [note for note in export(result(urdf), "mjcf", out) if note.code == "export_inertia"]
    assert [note.severity for note in notes] == ["warning"]
    assert "set to their mean" in notes[0].text
    assert "MuJoCo says" in notes[0].text
    model = mujoco.MjModel.from_xml_path(str(out))
    np.testing.assert_allclose(model.body("pelvis").inertia, 0.2, rtol=1e-6)
    np.testing.assert_allclose(model.body("left_shin").inertia, 0.05, rtol=1e-6)


def test_a_link_without_weight_gets_a_tenth_of_a_gram(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    urdf = write_urdf(tmp_path / "b.urdf")
    urdf.write_text(
        urdf.read_text().replace('<mass value="4"/>', '<mass value="0"/>').replace('"0.05"', '"0"')
    )
    codes = {note.code for note in export(result(urdf), "mjcf", tmp_path / "o.xml")}
    assert "export_inertia" in codes
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "o.xml"))
    assert model.body("left_shin").mass[0] == pytest.approx(1e-4)
    np.testing.assert_allclose(model.body("left_shin").inertia, 1e-7, rtol=1e-6)


@pytest.mark.parametrize(("name", "kept"), [("cover.STL", True), ("cover.stl", True), ("cover.dae", False)])
def test_meshes_that_mujoco_reads_stay_whatever_case_their_ending_has(
    name: str, kept: bool, tmp_path: Path
) -> None:
    mujoco = pytest.importorskip("mujoco")
    corners = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]], dtype="<f4")
    faces = [corners[[0, 2, 1]], corners[[0, 1, 3]], corners[[0, 3, 2]], corners[[1, 2, 3]]]
    solid = b"".join(bytes(12) + face.tobytes() + bytes(2) for face in faces)
    (tmp_path / name).write_bytes(bytes(80) + len(faces).to_bytes(4, "little") + solid)
    urdf, out = write_urdf(tmp_path / "b.urdf"), tmp_path / "o.xml"
    urdf.write_text(urdf.read_text().replace('<box size="0.08 0.08 0.4"/>', f'<mesh filename="{name}"/>', 1))
    notes = [note.text for note in export(result(urdf), "mjcf", out) if note.code == "export_mesh"]
    assert notes == (
        [] if kept else [f"meshes MuJoCo cannot read, left out, so those links touch nothing: {name}"]
    )
    assert mujoco.MjModel.from_xml_path(str(out)).nmesh == kept


@pytest.mark.parametrize("share", [0.65, 0.75])
def test_a_bush_that_is_quicker_than_the_time_step_is_named(share: float, tmp_path: Path) -> None:
    """C/K of the left pitch below and above 0.7 of the exported step of a millisecond."""
    pytest.importorskip("mujoco")
    made = result(write_urdf(tmp_path / "b.urdf"))
    for row in made["parameters"]:
        if (row["foot"], row["axis"], row["name"]) == ("left", "pitch", "damping"):
            row["value"] = share * 1e-3 * 480.0
    told = [note for note in export(made, "mjcf", tmp_path / "o.xml") if note.code == "export_timestep"]
    assert [note.severity for note in told] == ["warning"] * (share < 0.7)
    assert all("0.001 s is long for LLEG_BUSH_PITCH (C/K" in note.text for note in told)
