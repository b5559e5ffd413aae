"""A manifest from files: a group for each robot and day, with the time that log, name or file says."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace

import fsspec
import pytest

from command_line import refused, run
from fleet_samples import make_logs, short_log
from plantar.fleet import plan
from plantar.fleet.manifest import read_manifest
from plantar.fleet.plan import PlannedLog, find_logs, groups_of, sources_of, stamp_in
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log

MAY = datetime(2026, 5, 4, 9, 30, tzinfo=UTC)


def dated_log(path: Path, at: datetime) -> None:
    log = short_log(0)
    path.parent.mkdir(exist_ok=True, parents=True)
    save_log(MotionLog(path.stem, log.time + at.timestamp(), log.columns), path)


def test_logs_of_one_robot_and_day_are_one_group(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make_logs(tmp_path, 0)
    logs = tmp_path / "logs"
    dated_log(logs / "A-7" / "one.parquet", MAY)
    dated_log(logs / "A-7" / "two.csv", MAY.replace(hour=23))
    dated_log(logs / "A-7" / "three.parquet", MAY.replace(day=5))
    dated_log(logs / "B-1" / "one.parquet", MAY)
    (logs / "A-7" / "one.truth.parquet").write_bytes(b"")
    (logs / "A-7" / "notes.md").write_bytes(b"")
    out = tmp_path / "deep" / "fleet.csv"
    command = ["fleet", "plan", f"{logs}/**/*", "--robot", tmp_path / "robot.yaml", "--unit", "logs/([^/]+)/"]
    assert run(*command, "--out", out) == 0
    assert "3 groups of 4 logs; times from logs' stamps: 4" in capsys.readouterr().err
    first, second, third = read_manifest(out)
    assert (first.name, first.unit, first.time) == ("A-7 2026-05-04", "A-7", MAY)
    assert [Path(log.place).name for log in first.logs] == ["one.parquet", "two.csv"]
    assert (second.name, third.name) == ("A-7 2026-05-05", "B-1 2026-05-04")
    assert run(*command, "--quiet") == 0
    assert capsys.readouterr().out == out.read_text()


def test_what_is_named_from_here_is_found_from_the_manifests_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_logs(tmp_path, 0)
    dated_log(tmp_path / "logs" / "one.parquet", MAY)
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path)
    command = ("fleet", "plan", "logs/*.parquet", "--robot", "robot.yaml")
    assert run(*command, "--out", Path("out") / "fleet.csv", "--quiet") == 0
    (group,) = read_manifest(tmp_path / "out" / "fleet.csv")
    assert Path(group.robot).samefile(tmp_path / "robot.yaml")
    assert Path(group.robot).is_absolute()
    assert [Path(log.place) for log in group.logs] == [tmp_path / "logs" / "one.parquet"]


def test_without_a_date_in_the_log_its_name_or_file_says(tmp_path: Path) -> None:
    (name,) = make_logs(tmp_path, 1)
    (tmp_path / name).rename(tmp_path / "sway_2026-05-04-09-30.parquet")
    (tmp_path / "broken.parquet").write_bytes(b"")
    os.utime(tmp_path / "broken.parquet", (MAY.timestamp(), MAY.timestamp()))
    out = tmp_path / "fleet.csv"
    assert (
        run("fleet", "plan", f"{tmp_path}/*.parquet", "--robot", tmp_path / "robot.yaml", "--out", out) == 0
    )
    (group,) = read_manifest(out)
    assert (group.name, group.time, len(group.logs)) == ("robot 2026-05-04", MAY, 2)


@pytest.mark.parametrize(
    ("name", "time"),
    [
        ("rosbag2_2026_05_04-09_30_00", MAY),
        ("20260504T093000Z_sway", MAY),
        ("sway_20260504_093017", MAY.replace(second=17)),
        ("sway-2026-05-04", MAY.replace(hour=0, minute=0)),
        ("2025-01-01_sway_2026-05-04_09.30", MAY),
        ("2026-02-31", None),
        ("log_120260504", None),
        ("sway_12", None),
    ],
)
def test_dates_in_names(name: str, time: datetime | None) -> None:
    assert stamp_in(name) == time


def test_what_names_no_log_or_unit_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (name,) = make_logs(tmp_path, 1)
    robot = ["--robot", tmp_path / "robot.yaml"]
    assert "names no log" in refused(capsys, "fleet", "plan", f"{tmp_path}/*.bag", *robot)
    for unit in ("(", "(a)(b)", "nowhere/(.*)/"):
        assert run("fleet", "plan", tmp_path / name, *robot, "--unit", unit) == 2
        assert "Traceback" not in capsys.readouterr().err


def test_logs_of_a_day_stand_in_times_order_and_the_group_begins_with_the_first() -> None:
    def log(name: str, hour: int, unit: str = "a") -> PlannedLog:
        return PlannedLog(f"/{name}.csv", unit, datetime(2026, 5, 4, hour, tzinfo=UTC), "log")

    groups = groups_of(
        [log("first", 11), log("second", 9), log("other", 8, "b"), log("third", 10)], "robot.yaml"
    )
    assert [(group.name, group.unit, group.time) for group in groups] == [
        ("a 2026-05-04", "a", datetime(2026, 5, 4, 9, tzinfo=UTC)),
        ("b 2026-05-04", "b", datetime(2026, 5, 4, 8, tzinfo=UTC)),
    ]
    assert [one.place for one in groups[0].logs] == ["/second.csv", "/third.csv", "/first.csv"]
    counted = sources_of([log("x", 1), log("y", 2)])
    assert counted == "times from logs' stamps: 2"


def test_logs_of_a_store_keep_their_urls_and_each_is_named_once(tmp_path: Path) -> None:
    system = fsspec.filesystem("memory")
    for name in ("b.csv", "a.csv", "a.truth.parquet"):
        system.pipe_file(f"/plan/{name}", b"time\n")
    (tmp_path / "c.csv").write_text("time\n")
    patterns = ["memory://plan/*", str(tmp_path / "*.csv"), "memory://plan/a.csv"]
    assert find_logs(patterns) == ("memory:///plan/a.csv", "memory:///plan/b.csv", str(tmp_path / "c.csv"))


def test_a_bag_of_ros_2_is_one_log_whatever_lies_in_its_folder(tmp_path: Path) -> None:
    for name in ("bag/metadata.yaml", "bag/part_0.mcap", "beside/alone.mcap"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    assert find_logs([str(tmp_path / "**" / "*")]) == (
        str(tmp_path / "bag"),
        str(tmp_path / "beside" / "alone.mcap"),
    )


@pytest.mark.parametrize(
    ("first", "time"),
    [(MAY.timestamp() + 0.75, MAY), (0.0, None), (946684800.0, None), (4102444800.0, None), (4.2, None)],
)
def test_a_clock_that_tells_a_date_tells_it_to_the_second(
    first: float, time: datetime | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither one that starts with the log nor one that was never set, to the first day of 2000 or of 2100."""
    monkeypatch.setattr(plan, "open_log", lambda place, robot: SimpleNamespace(time=[first, first + 1]))
    assert plan._first_stamp("a.csv", None) == time  # type: ignore[arg-type]
