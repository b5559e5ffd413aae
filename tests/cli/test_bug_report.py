"""`plantar bug-report`: what helps to find a fault is in it, and nothing that is nobody's business."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy
import pytest
import yaml

from biped import record, sway
from biped_robot import write_robot
from command_line import run, write_csv
from plantar import __version__
from plantar.cli.bug_report import Folders


@pytest.fixture(scope="module")
def private(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A robot file and logs in a folder whose name is nobody's business."""
    folder = tmp_path_factory.mktemp("home") / "ann lee" / "secret"
    robot = write_robot(folder, topics={"chest": "/imu/data"})
    robot.write_text(robot.read_text() + "# call ann on 555-1234\n")
    log = record(sway("sway", 1, duration=8.0))
    write_csv(log, folder / "sway.csv")
    (folder / "broken.csv").write_text("time,a\n0,1\n0,2\n0,3\n")
    return folder


def report(capsys: pytest.CaptureFixture[str], *files: object) -> str:
    assert run("bug-report", *files) == 0
    return capsys.readouterr().out


def parts(text: str, kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def test_it_holds_versions_settings_and_what_inspect_says(
    private: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = report(capsys, private / "robot.yaml", private / "sway.csv")
    for name, value in (("plantar", __version__), ("numpy", numpy.__version__)):
        assert f"| {name} | {value} |" in text
    settings = yaml.safe_load(parts(text, "yaml")[0])
    assert settings["urdf"] == "biped.urdf"
    summaries = [f"{kind} {name}" for kind, name in (("robot file", "robot.yaml"), ("inspect", "sway.csv"))]
    assert re.findall("<summary>(.*)</summary>\n\n```", text) == summaries
    assert settings["topics"] == {"chest": "/imu/data"}
    inspection = json.loads(parts(text, "json")[0])
    run("inspect", private / "robot.yaml", private / "sway.csv", "--json", "--quiet")
    assert inspection == json.loads(capsys.readouterr().out)


def test_no_folder_no_comment_and_no_sample_is_in_it(
    private: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = report(capsys, private / "robot.yaml", private / "sway.csv", private / "broken.csv")
    for secret in ("ann", "secret", "555", str(private.parents[1]), str(Path.home())):
        assert secret not in text
    rows = (private / "sway.csv").read_text().splitlines()[100:110]
    assert not any(value in text for row in rows for value in row.split(",")[1:] if len(value) > 9)


def test_a_log_that_cannot_be_read_is_reported_and_the_others_are_too(
    private: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = report(
        capsys, private / "robot.yaml", private / "broken.csv", private / "none.csv", private / "sway.csv"
    )
    assert "`broken.csv` is refused: broken.csv" in text
    assert "`none.csv` is refused: none.csv: does not exist" in text
    assert len(parts(text, "json")) == 1


def test_a_robot_file_that_is_refused_ends_the_report(
    private: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "bad.yaml"
    bad.write_text("name: x\nurdf: none.urdf\nbase: fixed\n")
    text = report(capsys, bad, private / "sway.csv")
    assert "`bad.yaml` is refused: " in text
    assert "none.urdf" in text
    assert str(tmp_path) not in text


def test_paths_become_names_and_topics_stay(tmp_path: Path) -> None:
    folder = tmp_path / "logs of ann"
    known = Folders([folder / "robot.yaml", Path("data/sway.csv")])
    home = Path.home()
    assert known.left_out(f"{folder}/sway.csv: is empty") == "sway.csv: is empty"
    assert known.left_out("data/sway.csv, 'data/b.csv'") == "sway.csv, 'b.csv'"
    assert known.left_out(f"see {home}/x/y.urdf and ~/z.urdf") == "see y.urdf and z.urdf"
    assert known.left_out(r"C:\Users\ann\a.csv") == "a.csv"
    for kept in ("/imu/data", "N·m/rad", "metadata/x", "N/m, N·m/rad", "1/2"):
        assert known.left_out(kept) == kept
