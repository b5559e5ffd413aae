"""Files of controllers: the identified numbers, in each one's units and signs, and read back.

References for what nothing here can load: mc_rtc include/mc_rbdyn/Flexibility.h and src/mc_rbdyn/configuration_io.cpp
(flexibilities: jointName, K, C, O); rtmros_choreonoid hrpsys_choreonoid/config (bush: springT, dampingT, springR,
dampingR); mc_state_observation etc/MCKineticsObserver/robots (linStiffness, angStiffness, linDamping, angDamping).
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
import yaml

from export_robots import TRUTH
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.kinetics_observer import read_contacts
from plantar.exporters.mc_rtc import read_flexibilities

SIDES = {"left": "LLEG", "right": "RLEG"}


def test_mc_rtc_flexibilities_are_the_identified_numbers(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "mc_rtc", tmp_path / "a.json", with_offset=True)
    entries = {e["jointName"]: e for e in json.loads((tmp_path / "a.json").read_text())["flexibilities"]}
    assert set(entries) == {
        "LLEG_BUSH_Z",
        "LLEG_BUSH_PITCH",
        "LLEG_BUSH_ROLL",
        "RLEG_BUSH_PITCH",
        "RLEG_BUSH_ROLL",
    }
    for foot, axes in TRUTH.items():
        for axis, (k, c, o) in axes.items():
            entry = entries[f"{SIDES[foot]}_BUSH_{axis.upper()}"]
            assert (entry["K"], entry["C"], entry["O"]) == pytest.approx((k, c, o))
    export(feet, "mc_rtc", tmp_path / "b.json")
    assert all(e["O"] == 0 for e in json.loads((tmp_path / "b.json").read_text())["flexibilities"])


def test_mc_rtc_and_the_observer_are_read_back(feet: dict[str, Any], tmp_path: Path) -> None:
    """What a reader finds pushes as plantar's law: the sign of the offset, radians, x for roll."""
    export(feet, "mc_rtc", tmp_path / "a.json", with_offset=True)
    found = read_flexibilities(tmp_path / "a.json")
    assert len(found) == 5
    for foot, axes in TRUTH.items():
        for axis, truth in axes.items():
            one = found[f"{SIDES[foot]}_BUSH_{axis.upper()}"]
            assert (one.stiffness, one.damping, one.offset) == pytest.approx(truth)
    export(feet, "kinetics_observer", tmp_path / "k.yaml")
    contacts = read_contacts(tmp_path / "k.yaml")
    assert contacts["pitch"] == pytest.approx((457, 20.08))
    assert contacts["roll"] == pytest.approx((337.5, 22.84))
    assert contacts["z"] == (40000, 400)
    rigid = (tmp_path / "k.yaml").read_text().replace("400", "0")
    (tmp_path / "k.yaml").write_text(rigid)
    assert read_contacts(tmp_path / "k.yaml")["z"] == (0, 0), "none at all is a number, too"


@pytest.mark.parametrize(
    "text",
    ["nonsense: [", "[1, 2]", '{"flexibilities": [{"jointName": "a", "K": 1}]}', "linStiffness: [1, 2, .nan]",
     "{linStiffness: [1, 1, 1], angStiffness: [1, 1, .inf], linDamping: [1, 1, 1], angDamping: [1, 1, 1]}",
     '{"flexibilities": [{"jointName": "a", "K": -1, "C": 0, "O": 0}]}'],
)  # fmt: skip
def test_a_broken_configuration_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "a").write_text(text)
    for read in (read_flexibilities, read_contacts):
        with pytest.raises(ExportError, match="valid:"):
            read(tmp_path / "a")


def test_choreonoid_takes_means(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "choreonoid", tmp_path / "c.yaml")
    bush = yaml.safe_load((tmp_path / "c.yaml").read_text())["bush"]
    assert bush["springT"] == 40000
    assert bush["springR"] == pytest.approx((480 + 352 + 434 + 323) / 4)
    assert bush["dampingR"] == pytest.approx((24.27 + 28.15 + 15.89 + 17.53) / 4)


def test_kinetics_observer_puts_roll_on_x_and_pitch_on_y(feet: dict[str, Any], tmp_path: Path) -> None:
    notes = export(feet, "kinetics_observer", tmp_path / "k.yaml")
    values = yaml.safe_load((tmp_path / "k.yaml").read_text())
    assert values["angStiffness"] == pytest.approx([(352 + 323) / 2, (480 + 434) / 2, 400])
    assert values["angDamping"] == pytest.approx([(28.15 + 17.53) / 2, (24.27 + 15.89) / 2, 12])
    assert values["linStiffness"] == [40000, 40000, 40000]
    assert values["linDamping"] == [120, 120, 400]
    assert "export_default" in {note.code for note in notes}


@pytest.mark.parametrize(
    ("entries", "wrong"),
    [
        ([("a", 1, 0, -2), ("b", 0, 3, 0)], None),
        ([("a", 1, 0, 0), ("a", 2, 0, 0)], 2),
        ([("a", 1, 0, 0), ("", 2, 0, 0)], 2),
        ([("a", 1, -1, 0)], 1),
        ([("a", 1, 0, math.inf)], 1),
        ([("a", math.nan, 0, 0)], 1),
    ],
)
def test_each_flexibility_is_one_joints_with_numbers_that_a_spring_has(
    entries: list[tuple[str, float, float, float]], wrong: int | None, tmp_path: Path
) -> None:
    path = tmp_path / "module.json"
    listed = [dict(zip(("jointName", "K", "C", "O"), entry, strict=True)) for entry in entries]
    path.write_text(json.dumps({"flexibilities": listed}))
    if wrong is None:
        found = read_flexibilities(path)
        assert {name: (one.stiffness, one.damping, one.offset) for name, one in found.items()} == {
            name: (stiffness, damping, offset) for name, stiffness, damping, offset in entries
        }
        return
    with pytest.raises(ExportError, match=f"flexibility {wrong} is no joint with K, C and O"):
        read_flexibilities(path)
