"""How a robot file names its URDF: from its own folder, or whole where it lies elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from plantar.robot_guess import _relative


def test_a_urdf_below_the_file_is_named_from_there_and_another_as_a_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    out = Path("robots/biped.yaml")
    assert _relative(Path("robots/meshes/biped.urdf"), out) == "meshes/biped.urdf"
    assert _relative(Path("biped.urdf"), out) == str(tmp_path.resolve() / "biped.urdf")
    assert _relative(Path("robots/../biped.urdf"), Path("robot.yaml")) == "biped.urdf"
