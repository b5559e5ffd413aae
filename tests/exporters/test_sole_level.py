"""A model whose soles lie elsewhere than the result's: said from two centimetres on, up or down."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from export_robots import write_mjcf
from plantar.exporters import export


@pytest.mark.parametrize(
    ("shift", "told"), [(0.0195, False), (0.0205, True), (-0.0195, False), (-0.0205, True)]
)
def test_a_sole_two_centimetres_off_is_another_link_s(
    shift: float, told: bool, feet: dict[str, Any], tmp_path: Path
) -> None:
    """The model's soles lie 30 mm below the bushes."""
    pytest.importorskip("mujoco")
    for foot in feet["robot_model"]["feet"].values():
        foot["sole"]["xyz"] = [0.0, 0.0, shift]
    model = write_mjcf(tmp_path / "model.xml")
    found = export(feet, "mjcf", tmp_path / "out.xml", model=model)
    texts = [note.text for note in found if note.code == "export_sole_level"]
    depth = 0.03 - shift
    said = f"lies 0.030 m below the bush, the result's sole {depth:.3f} m: is 'left_ankle' the URDF's link?"
    assert any(said in text for text in texts) == told
    assert len(texts) == 2 * told
