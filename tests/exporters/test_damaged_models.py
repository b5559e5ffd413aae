"""What exports make of models and controllers' files in which one thing is wrong, as it is kept."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from damaged import damaged, damaged_xml, told
from export_robots import result, write_mjcf, write_sdf, write_urdf
from kept_texts import assert_as_kept
from plantar.exporters import export
from plantar.exporters.kinetics_observer import read_contacts
from plantar.exporters.mc_rtc import read_flexibilities

KEPT = Path(__file__).parent / "kept"
MODELS: dict[str, tuple[str, Callable[[Path], Path]]] = {
    "urdf": ("urdf", lambda folder: write_urdf(folder / "robot.urdf")),
    "sdf": ("sdf", lambda folder: write_sdf(folder / "robot.sdf", "1.9")),
    "old_sdf": ("drake", lambda folder: write_sdf(folder / "robot.sdf", "1.6")),
    "mjcf": ("mjcf", lambda folder: write_mjcf(folder / "robot.xml")),
}


@pytest.mark.parametrize("name", MODELS)
def test_a_model_with_one_thing_wrong_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    """Each refusal; of what is written all the same, how many lines differ, and what is said of it beside the rest."""
    target, write = MODELS[name]
    made, model, out = result(write_urdf(tmp_path / "biped.urdf")), write(tmp_path), tmp_path / "out.xml"

    def written(text: str) -> list[str]:
        model.write_text(text)
        notes = export(made, target, out, model)
        body = ET.canonicalize(out.read_text(), strip_text=True).replace("><", ">\n<").splitlines()
        return [*(note.text for note in notes), *body]

    def changed(text: str) -> str:
        lines = written(text)
        said = [line for line in lines if line not in whole and not line.startswith("<")]
        new, lost = sum(line not in whole for line in lines), sum(line not in lines for line in whole)
        return f"{new} lines, {lost} lost; {said}"

    content = model.read_text()
    whole = written(content)
    lines = [f"{where}: {told(changed, text)}\n" for where, text in damaged_xml(content)]
    text = re.sub(r"(?<=MuJoCo refuses the model: ).*", "", "".join(lines))  # in the words of its version
    assert_as_kept(text.replace(str(tmp_path), "FOLDER"), KEPT / f"damaged_{name}.txt")


@pytest.mark.parametrize(
    ("target", "read", "dump"),
    [("mc_rtc", read_flexibilities, json.dumps), ("kinetics_observer", read_contacts, yaml.dump)],
)
def test_a_controllers_file_with_one_thing_wrong_is_as_it_is_kept(
    target: str, read: Callable[[Path], Any], dump: Callable[[Any], str], tmp_path: Path
) -> None:
    file = tmp_path / "feet.yaml"
    export(result(write_urdf(tmp_path / "biped.urdf")), target, file, with_offset=target == "mc_rtc")

    def found(content: Any) -> str:
        file.write_text(dump(content))
        return str(read(file))

    content = yaml.safe_load(file.read_text())
    lines = [f"{where}: {told(found, other)}\n" for where, other in [("whole", content), *damaged(content)]]
    assert_as_kept("".join(lines).replace(str(tmp_path), "FOLDER"), KEPT / f"damaged_{target}.txt")
