"""OpenHRP's bush customizer, written and read."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from export_robots import TRUTH
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.openhrp import read_customizer

SIDES = {"left": "LLEG", "right": "RLEG"}


def test_openhrp_lists_joint_spring_damping(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "openhrp", tmp_path / "bush.conf")
    lines = [line for line in (tmp_path / "bush.conf").read_text().splitlines() if not line.startswith("#")]
    assert lines[0] == "robot_model_name: biped"
    assert lines[1] == ("bush_config: LLEG_BUSH_Z,40000,400 LLEG_BUSH_ROLL,352,28.15 LLEG_BUSH_PITCH,480,24.27 "
                        "RLEG_BUSH_ROLL,323,17.53 RLEG_BUSH_PITCH,434,15.89")  # fmt: skip


def test_openhrp_does_not_tell_of_rests_that_its_springs_lack(feet: dict[str, Any], tmp_path: Path) -> None:
    for with_offset in (False, True):
        export(feet, "openhrp", tmp_path / "bush.conf", with_offset=with_offset)
        text = (tmp_path / "bush.conf").read_text()
        assert "rests at -offset/K" not in text
        assert "offset =" not in text


def test_openhrp_reads_what_it_writes(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "openhrp", tmp_path / "bush.conf")
    read = read_customizer(tmp_path / "bush.conf")
    assert read.robot == "biped"
    wanted = {
        f"{SIDES[foot]}_BUSH_{axis.upper()}": (k, c)
        for foot, axes in TRUTH.items()
        for axis, (k, c, _) in axes.items()
    }
    assert read.joints == wanted


def test_openhrp_reads_a_file_of_another_hand(tmp_path: Path) -> None:
    file = tmp_path / "own.conf"
    file.write_text(
        "# feet\n\nother: 1\nbush_config :  RLEG_BUSH_Z,1.1e6,1e3   RLEG_BUSH_PITCH,2500,2.5 # soft\n"
    )
    assert read_customizer(file).joints == {"RLEG_BUSH_Z": (1.1e6, 1e3), "RLEG_BUSH_PITCH": (2500.0, 2.5)}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("robot_model_name: r\n", "bush_config"),
        ("bush_config: A,1\n", "line 1: 'A,1'"),
        ("\nbush_config: A,1,2,3\n", "line 2: 'A,1,2,3'"),
        ("bush_config: A,stiff,2\n", "'A,stiff,2'"),
        ("bush_config: A,-1,2\n", "'A,-1,2'"),
        ("bush_config: A,1,inf\n", "'A,1,inf'"),
        ("bush_config: A,1,2 A,1,2\n", "each joint once"),
    ],
)
def test_openhrp_says_what_it_cannot_read(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "x.conf").write_text(text)
    with pytest.raises(ExportError, match=re.escape(said)) as caught:
        read_customizer(tmp_path / "x.conf")
    assert "\n" not in str(caught.value)


def test_of_a_long_entry_its_beginning_is_told(tmp_path: Path) -> None:
    (tmp_path / "bush.conf").write_text(f"# feet\nbush_config: a,1,2 {'b' * 80},1\n")
    with pytest.raises(
        ExportError, match=rf"bush\.conf: line 2: '{'b' * 60}' is no entry of 'bush_config' \(valid: "
    ):
        read_customizer(tmp_path / "bush.conf")
