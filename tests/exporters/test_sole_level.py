"""A model whose soles lie elsewhere than the result's: said from two centimetres on, up or down."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_robots import CENTRE, POLYGON, SOLE_Z, bush_rotation, write_mjcf
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.mjcf.file import INCLUDE_LIMIT
from plantar.notes import Notes


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


@pytest.mark.parametrize(
    ("target", "named"),
    [("bullet-contact", "left_ankle foot, left_sole low"),
     ("drake-contact", "left_ankle_collision_1, left_sole_collision_0")],
)  # fmt: skip
def test_shapes_of_links_below_the_ankle_touch_nothing_any_more(
    target: str, named: str, urdf: Path, feet: dict[str, Any], tmp_path: Path
) -> None:
    """A box on the sole's own link, and one as far above the ankle."""
    shape = '<collision name="{}"><origin xyz="0 0 {}"/><geometry><box size="0.1 0.1 0.01"/></geometry></collision>'
    link = f'<link name="left_sole">{shape.format("low", 0)}{shape.format("high", 0.22)}</link>'
    urdf.write_text(urdf.read_text().replace('<link name="left_sole"/>', link))
    notes = export(feet, target, tmp_path / "out", model=urdf)
    (silent,) = [note.text for note in notes if note.code == "export_silent" and note.text.startswith("left")]
    assert silent.endswith(f"touch instead: {named}")


@pytest.mark.parametrize(("files", "valid"), [(0, True), (1, False)])
def test_includes_are_bounded(files: int, valid: bool, tmp_path: Path) -> None:
    from plantar.exporters.mjcf.file import load_mjcf

    assert INCLUDE_LIMIT == 100
    (tmp_path / "one.xml").write_text("<mujoco/>")
    includes = '<include file="one.xml"/>' * (100 + files)
    (tmp_path / "model.xml").write_text(f"<mujoco>{includes}<worldbody/></mujoco>")
    if valid:
        load_mjcf(tmp_path / "model.xml", Notes())
    else:
        with pytest.raises(
            ExportError, match=r"test_includes_are_bounded_1_Fa0: includes more than 100 files$"
        ):
            load_mjcf(tmp_path / "model.xml", Notes())


def test_a_plate_lies_as_the_bush_under_a_model_without_feet(feet: dict[str, Any], tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    model = write_mjcf(tmp_path / "model.xml")
    lines = [line for line in model.read_text().splitlines() if '_foot"' not in line and "_heel" not in line]
    model.write_text("\n".join(lines))
    notes = export(feet, "mjcf", tmp_path / "out.xml", model=model)
    assert "export_plate" in {note.code for note in notes}
    made = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    plate, turn = made.geom("left_bush_plate"), np.zeros(9)
    mujoco.mju_quat2Mat(turn, plate.quat)
    np.testing.assert_allclose(turn.reshape(3, 3), bush_rotation("left"), atol=1e-6)
    bottom = plate.pos - bush_rotation("left")[:, 2] * plate.size[2]
    assert (bottom - CENTRE) @ bush_rotation("left")[:, 2] == pytest.approx(-0.03, abs=1e-3)
    corners = (np.column_stack([POLYGON, 4 * [SOLE_Z]]) - CENTRE) @ bush_rotation("left")
    middle = (corners.min(axis=0) + corners.max(axis=0))[:2] / 2
    assert ((plate.pos - CENTRE) @ bush_rotation("left"))[:2] == pytest.approx(middle, abs=1e-6)
