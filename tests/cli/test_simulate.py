"""`plantar simulate`, as a user calls it."""

from __future__ import annotations

import json
from importlib import import_module
from pathlib import Path

import pytest
import yaml

import command_line
from plantar.cli.simulate import _bushes, _reporter
from plantar.errors import PlantarError
from plantar.fleet.manifest import read_manifest
from plantar.logs.readers import open_log
from plantar.robot.model import load_robot
from plantar.twin import Bush, fleet
from plantar.twin.robots.hrp2 import write
from twin_samples import plan, planned_part, short


@pytest.fixture(autouse=True)
def parts_of_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("plantar.twin.play"), "planned", planned_part)


def run(*arguments: str) -> int:
    return command_line.run("simulate", *arguments)


def test_a_fleet_has_a_manifest(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fleet, "planned", lambda motion, _: short(plan(motion), 2.0, 6.0))
    assert run("fleet", "--robots", "2", "--days", "1", "--out", str(tmp_path), "--quiet") == 0
    assert [group.unit for group in read_manifest(tmp_path / "fleet.csv")] == ["robot_01", "robot_02"]
    assert "2 logs of 2 robots on 1 days" in capsys.readouterr().out
    assert run("fleet", "--preset", "imperfect", "--out", str(tmp_path), "--quiet") == 1
    assert "valid: sensors, realistic" in capsys.readouterr().err


def test_logs_truth_and_robot_file_appear(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("Squat", "--out", str(tmp_path), "--preset", "sensors", "--seed", "3") == 0
    robot = load_robot(tmp_path / "robot.yaml")
    log = open_log(tmp_path / "Squat.parquet", robot)
    assert log.duration == pytest.approx(9.995)
    assert log.period == pytest.approx(0.005)
    assert log.positions(robot).shape == (2000, 30)
    assert json.loads((tmp_path / "Squat.truth.json").read_text())["seed"] == 3
    said = capsys.readouterr()
    assert "Squat" in said.out
    assert "1 of 1 motions played" in said.err
    # the same seed again, from the cache: the same bytes
    before = (tmp_path / "Squat.parquet").read_bytes()
    assert (
        run("Squat", "--out", str(tmp_path / "again"), "--preset", "sensors", "--seed", "3", "--quiet") == 0
    )
    assert (tmp_path / "again" / "Squat.parquet").read_bytes() == before
    assert capsys.readouterr().err == ""


def test_a_robot_of_the_users_own_comes_with_its_robot_file(tmp_path: Path) -> None:
    """So that what is simulated can be identified: URDF and robot file stand beside the logs."""
    own = Path(write(tmp_path / "own"))
    assert (
        run("Squat", "--robot", str(own), "--out", str(tmp_path / "out"), "--preset", "ideal", "--quiet") == 0
    )
    copy = tmp_path / "out" / "robot.yaml"
    assert yaml.safe_load(copy.read_text()) == yaml.safe_load(own.read_text())
    robot = load_robot(copy)
    assert open_log(tmp_path / "out" / "Squat.parquet", robot).has_imu("chest", "orientation")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["Jump"], "unknown motion 'Jump'"),
        (["Squat", "--preset", "odd"], "unknown preset 'odd'"),
        (["Squat", "--bush", "1,2,x"], "--bush is not four or six numbers"),
        (["Squat", "--robot", "missing.yaml"], "missing.yaml: cannot be read"),
        (["Tilt1", "--sway", "nan"], "--sway is no length"),
        (["Squat", "--vertical", "0"], "--vertical is no length"),
        (["Tilt1", "--apart", "0.1"], "the soles would stand on each other"),
        (["Squat", "--vertical", "0.6"], "s: Squat: the chest cannot reach its place, it falls short by"),
        (["Manual_right_roll", "--sway", "0.3"], "the zero-moment point leaves the support polygon by"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(
    arguments: list[str], line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(*arguments, "--out", str(tmp_path / "out")) == 1
    said = capsys.readouterr().err
    assert line in said
    assert said.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "text", ["1000,20,800", "1000,20,800,16,4e5", "-1,20,800,16", "1e9,20,800,16", "nan,20,800,16"]
)
def test_a_bush_has_four_or_six_numbers_from_nothing_on(text: str) -> None:
    assert _bushes("1000,0,800,0") == dict.fromkeys(("left", "right"), Bush(1000.0, 0.0, 800.0, 0.0))
    assert _bushes("1000,20,800,16,4e5,1e3")["right"] == Bush(1000.0, 20.0, 800.0, 16.0, 4e5, 1e3)
    with pytest.raises(PlantarError, match="--bush is not four or six numbers that are at least 0"):
        _bushes(text)


def test_a_robot_on_unknown_bushes_is_asked_for_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = Path(write(tmp_path / "own"))
    own.write_text(own.read_text().replace("hrp2_like", "another"))
    assert run("Squat", "--robot", str(own), "--out", str(tmp_path / "out")) == 1
    assert "'another' stands on unknown bushes (valid: --bush K_pitch,C_pitch" in capsys.readouterr().err


def test_motions_that_play_are_told_a_tenth_at_a_time() -> None:
    said: list[str] = []
    report = _reporter(2, said.append)
    for motion, share in (
        ("a", 0.01),
        ("a", 0.05),
        ("b", 0.31),
        ("a", 0.12),
        ("a", 1.0),
        ("b", 0.39),
        ("b", 1.0),
    ):
        report(motion, share)
    assert said == [
        "0 of 2 motions played, a 0 %", "0 of 2 motions played, a 0 %, b 30 %", "0 of 2 motions played, a 10 %, b 30 %",
        "1 of 2 motions played, b 30 %", "2 of 2 motions played",
    ]  # fmt: skip
