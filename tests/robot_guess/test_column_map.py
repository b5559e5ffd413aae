"""`init` on logs whose columns have other names."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from command_line import run
from page_folders import other_names
from plantar.errors import RobotError
from plantar.logs.readers import open_log
from plantar.robot.model import load_robot
from plantar.robot_guess.column_map import read_column_map


def test_init_reads_logs_by_the_map_and_takes_it_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other_names(tmp_path)
    urdf, log, columns, out = (
        tmp_path / name for name in ("robot.urdf", "logger.csv", "columns.yaml", "my.yaml")
    )
    assert run("init", urdf, log, "--out", out) == 1
    assert "--columns FILE" in capsys.readouterr().err
    assert run("init", urdf, log, "--columns", columns, "--out", out) == 0
    robot = load_robot(out)
    assert columns.read_text() in out.read_text()
    assert robot.imu is not None
    assert (robot.imu.name, {foot.wrench.name for foot in robot.feet.values()}) == (
        "chest",
        {"left", "right"},
    )
    assert set(robot.joint_names) <= {name.split(".")[1] for name in open_log(log, robot).columns}
    assert "# Seen: the feet carry" in out.read_text()


def test_what_is_wrong_with_the_map_names_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other_names(tmp_path)
    (tmp_path / "wrong.yaml").write_text("columns:\n  time: {from: stamp, unit: hours}\n")
    words = ("init", tmp_path / "robot.urdf", tmp_path / "logger.csv", "--columns", tmp_path / "wrong.yaml")
    assert run(*words, "--out", tmp_path / "my.yaml") == 1
    assert "wrong.yaml, value 'hours': columns.time" in capsys.readouterr().err


@pytest.mark.parametrize(
    "text",
    ["", "columns: 3", "columns: {}\nname: x", "[" * 5000, "a: [", "- columns", "\x00", "&a [*a]", "\xff"],
)
def test_a_file_that_is_no_map_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "map.yaml").write_bytes(text.encode("latin-1"))
    with pytest.raises(RobotError, match=r"map\.yaml: (is no|is nested|uses)") as caught:
        read_column_map(tmp_path / "map.yaml")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text", ["columns: {time: t}", "---\ncolumns: {time: t}\n...\n", "\ufeffcolumns: {time: t}"]
)
def test_a_map_can_stand_at_the_end_of_a_robot_file(text: str, tmp_path: Path) -> None:
    (tmp_path / "map.yaml").write_text(text)
    written = "name: robot\n" + read_column_map(tmp_path / "map.yaml")
    assert yaml.safe_load(written) == {"name": "robot", "columns": {"time": "t"}}
    assert written.endswith("\n")
