"""A fleet from its manifest to its tables: nothing lost, nothing twice, broken logs told."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pyarrow.parquet as pa_parquet
import pytest

from biped import TRUTH
from command_line import refused, run
from fleet_samples import broken_logs, make_logs, short_log, small_fleet, write_manifest
from plantar.errors import PlantarError
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.fleet.manifest import read_manifest
from plantar.fleet.places import PlaceError, Store
from plantar.fleet.robots import robot_at
from plantar.fleet.run import Outcome, run_fleet
from plantar.fleet.work import Task, compute
from plantar.logs.save import save_log

SETTINGS = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)


def done(client: Any, manifest: Path, out: Path, settings: FeetSettings = SETTINGS) -> Outcome:
    return run_fleet(read_manifest(manifest), Store(str(out)), settings, client)


def test_a_fleet_finds_what_identify_feet_finds(client: Any, tmp_path: Path) -> None:
    manifest = small_fleet(tmp_path, 3)
    outcome = done(client, manifest, tmp_path / "out")
    assert (outcome.groups, outcome.reused, outcome.written.finished, outcome.written.failed) == (3, 0, 3, 0)
    rows = pa_parquet.read_table(tmp_path / "out" / "results.parquet").to_pylist()
    alone = identify_feet(tmp_path / "robot.yaml", tmp_path / "log_1.parquet", settings=SETTINGS)
    own = {(row["foot"], row["axis"], row["name"]): row for row in rows if row["group"] == "g1"}
    assert len(own) == len(alone.parameters)
    for parameter in alone.parameters:
        row = own[parameter.foot, parameter.axis, parameter.name]
        assert (row["value"], row["std"], row["verdict"]) == (
            parameter.value,
            parameter.std,
            parameter.verdict,
        )
        assert (row["low"], row["high"]) == (parameter.interval95 or (None, None))
        assert (row["unit_of_value"], row["unit"]) == (parameter.unit, "unit 1")
    pitch = own["left", "pitch", "stiffness"]
    assert pitch["value"] == pytest.approx(TRUTH["left", "pitch"].stiffness, rel=0.02)
    assert pitch["time"].isoformat() == "2026-03-02T10:00:00+00:00"


def test_the_next_run_computes_only_what_is_new(client: Any, tmp_path: Path) -> None:
    manifest, out = small_fleet(tmp_path, 3), tmp_path / "out"
    done(client, manifest, out)
    first = (out / "results.parquet").read_bytes()
    units = {path: path.stat().st_mtime_ns for path in (out / "units").rglob("*.json")}
    again = done(client, manifest, out)
    assert again.reused == 3
    assert (out / "results.parquet").read_bytes() == first
    more = small_fleet(tmp_path, 4)
    assert done(client, more, out).reused == 3
    assert {path: path.stat().st_mtime_ns for path in units} == units
    assert len(list((out / "units").rglob("*.json"))) == 4


def test_content_counts_not_the_place_or_the_date(client: Any, tmp_path: Path) -> None:
    """A log that moved or was touched is not fitted again; other content, settings or another robot file are."""
    manifest, out = small_fleet(tmp_path, 1), tmp_path / "out"
    done(client, manifest, out)
    log = tmp_path / "log_0.parquet"
    os.utime(log, (1, 1))
    assert done(client, manifest, out).reused == 1
    (tmp_path / "elsewhere").mkdir()
    log.rename(tmp_path / "elsewhere" / log.name)
    moved = write_manifest(tmp_path / "moved.csv", [("m", "robot.yaml", f"elsewhere/{log.name}", "", "", "")])
    assert done(client, moved, out).reused == 1
    assert done(client, moved, out, FeetSettings(model="kelvin_voigt", wrench_delay=0.001)).reused == 0
    robot = tmp_path / "robot.yaml"
    robot.write_text(robot.read_text() + "\n# measured again\n")
    assert done(client, moved, out).reused == 0
    save_log(short_log(1), tmp_path / "elsewhere" / log.name)  # recorded anew
    assert done(client, moved, out).reused == 0
    assert done(client, moved, out).reused == 1


def test_broken_logs_of_ten_kinds_are_told_and_do_no_harm(client: Any, tmp_path: Path) -> None:
    (good,) = make_logs(tmp_path, 1)
    broken = broken_logs(tmp_path)
    assert len(broken) == 10
    rows = [(name, "robot.yaml", name, "", "", "") for name in (*broken, good)]
    outcome = done(client, write_manifest(tmp_path / "fleet.csv", rows), tmp_path / "out")
    assert (outcome.written.finished, outcome.written.failed) == (1, 10)
    results = pa_parquet.read_table(tmp_path / "out" / "results.parquet")
    assert set(results["group"].to_pylist()) == {good}
    failures = pa_parquet.read_table(tmp_path / "out" / "failures.parquet").to_pylist()
    assert [row["group"] for row in failures] == list(broken)
    for row in failures:
        assert row["log"] == str(tmp_path / row["group"])
        assert broken[row["group"]] in row["error"]
        assert "\n" not in row["error"]
        assert "internal error" not in row["error"]


def test_a_broken_log_is_left_out_of_its_group(client: Any, tmp_path: Path) -> None:
    names = make_logs(tmp_path, 2)
    broken_logs(tmp_path)
    rows = [("g", "robot.yaml", name, "", "", "") for name in (*names, "cut.parquet", "short.parquet")]
    outcome = done(client, write_manifest(tmp_path / "fleet.csv", rows), tmp_path / "out")
    assert (outcome.written.finished, outcome.written.failures) == (1, 2)
    alone = identify_feet(tmp_path / "robot.yaml", [tmp_path / name for name in names], settings=SETTINGS)
    found = pa_parquet.read_table(tmp_path / "out" / "results.parquet")["value"].to_pylist()
    assert found == [row.value for row in alone.parameters]


def test_a_failure_names_the_log_where_it_is_now(client: Any, tmp_path: Path) -> None:
    make_logs(tmp_path, 0)
    broken_logs(tmp_path)
    out = tmp_path / "out"
    done(client, write_manifest(tmp_path / "a.csv", [("g", "robot.yaml", "cut.parquet", "", "", "")]), out)
    (tmp_path / "moved").mkdir()
    (tmp_path / "cut.parquet").rename(tmp_path / "moved" / "cut.parquet")
    moved = write_manifest(tmp_path / "b.csv", [("g", "robot.yaml", "moved/cut.parquet", "", "", "")])
    assert done(client, moved, out).reused == 1
    (row,) = pa_parquet.read_table(out / "failures.parquet").to_pylist()
    assert row["log"] == str(tmp_path / "moved" / "cut.parquet")
    assert row["error"].startswith(row["log"])


def test_a_robot_file_that_is_wrong_fails_its_groups_only(client: Any, tmp_path: Path) -> None:
    good, other = make_logs(tmp_path, 2)
    rows = [("a", "robot.yaml", good, "", "", ""), ("b", "nowhere.yaml", other, "", "", "")]
    outcome = done(client, write_manifest(tmp_path / "fleet.csv", rows), tmp_path / "out")
    assert (outcome.written.finished, outcome.written.failed) == (1, 1)
    (row,) = pa_parquet.read_table(tmp_path / "out" / "failures.parquet").to_pylist()
    assert row["group"] == "b"
    assert "nowhere.yaml" in row["error"]


def test_a_damaged_unit_is_made_again(client: Any, tmp_path: Path) -> None:
    manifest, out = small_fleet(tmp_path, 1), tmp_path / "out"
    done(client, manifest, out)
    first = (out / "results.parquet").read_bytes()
    (unit,) = (out / "units").rglob("*.json")
    unit.write_bytes(unit.read_bytes()[:100])
    assert done(client, manifest, out).reused == 0
    assert (out / "results.parquet").read_bytes() == first


def test_a_store_that_cannot_be_written_stops_the_run(client: Any, tmp_path: Path) -> None:
    manifest, out = small_fleet(tmp_path, 1), tmp_path / "out"
    out.write_text("")
    with pytest.raises(PlaceError, match=r"result\.json: cannot be written: Not a directory$"):
        done(client, manifest, out)


def test_a_running_cluster_does_the_work(
    client: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest, address = small_fleet(tmp_path, 2), client.scheduler.address
    command = ["fleet", "run", manifest, "--out", tmp_path / "out", "--model", "kelvin_voigt", "--quiet"]
    assert run(*command, "--scheduler", address) == 0
    assert len(pa_parquet.read_table(tmp_path / "out" / "groups.parquet")) == 2
    line = refused(capsys, *command, "--scheduler", "nowhere")
    assert "value 'nowhere': no scheduler answers" in line


def test_workers_elsewhere_find_what_is_named_from_here(
    client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of a running cluster work in folders of their own."""
    small_fleet(tmp_path / "logs", 1)
    monkeypatch.chdir(tmp_path)
    command = ["fleet", "run", "logs/fleet.csv", "--out", "out", "--model", "kelvin_voigt", "--quiet"]
    assert run(*command, "--scheduler", client.scheduler.address) == 0
    assert len(pa_parquet.read_table("out/groups.parquet")) == 1
    assert len(list(Path("out/units").rglob("*.json"))) == 1


def test_the_command_ends_with_the_counts(
    client: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (name,) = make_logs(tmp_path, 1)
    rows = [("good", "robot.yaml", name, "", "", ""), ("bad", "robot.yaml", "gone.parquet", "", "", "")]
    manifest = write_manifest(tmp_path / "fleet.csv", rows)
    command = [
        "fleet",
        "run",
        manifest,
        "--out",
        tmp_path / "out",
        "--scheduler",
        client.scheduler.address,
        "--model",
        "kelvin_voigt",
    ]
    assert run(*command) == 0
    *_, failed, _, last = capsys.readouterr().out.splitlines()
    assert failed.startswith("failed, 1 like this: ")
    assert last == "2 groups: 1 with results, 0 were there already, 1 failed, 1 failures in failures.parquet"
    page = (tmp_path / "out" / "fleet.html").read_text()
    assert "1 groups" in page or "2 groups of" in page
    assert "does not exist" in page
    assert run(*command, "--json") == 0
    counts = json.loads(capsys.readouterr().out)
    assert (counts["groups"], counts["reused"], counts["written"]["failures"]) == (2, 1, 1)
    assert run("fleet", "report", tmp_path / "out") == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(tmp_path / "out" / "fleet.html")
    assert "results.parquet: does not exist" in refused(capsys, "fleet", "report", tmp_path)
    assert run(*command, "--workers", "1") == 2


def test_what_another_machine_could_do_is_tried_again(tmp_path: Path) -> None:
    """No memory for a log, a package that is missing: failures of this run, not of the log."""
    group = read_manifest(small_fleet(tmp_path, 1))[0]
    task = Task(robot_at(group.robot), group.logs, SETTINGS, Store(str(tmp_path / "out")), memory=1000)
    poor = compute(task)
    assert (poor.key, poor.failed) == (None, True)
    assert poor.failures[0].log == group.logs[0].place
    assert "--memory" in poor.failures[0].error
    rich = compute(replace(task, memory=None))
    assert (rich.reused, rich.failed) == (False, False)
    assert compute(task).reused


def test_a_robot_file_that_changes_meanwhile_is_told(tmp_path: Path) -> None:
    group = read_manifest(small_fleet(tmp_path, 1))[0]
    task = Task(
        replace(robot_at(group.robot), sha256="0"),
        group.logs,
        SETTINGS,
        Store(str(tmp_path / "out")),
        memory=None,
    )
    with pytest.raises(
        PlantarError, match=r"robot\.yaml: changed while the fleet was running \(valid: a new run\)$"
    ):
        compute(task)


def test_without_dask_the_extra_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    line = refused(capsys, "fleet", "run", small_fleet(tmp_path, 1), "--out", tmp_path / "out", "--quiet")
    assert "pip install 'plantar[fleet]'" in line


def test_a_group_that_a_new_log_joined_is_fitted_again(client: Any, tmp_path: Path) -> None:
    """With the log that was fitted alone before, which is no result of both."""
    make_logs(tmp_path, 2)
    out, rows = tmp_path / "out", [("g", "robot.yaml", f"log_{k}.parquet", "", "", "") for k in range(2)]
    done(client, write_manifest(tmp_path / "one.csv", rows[:1]), out)
    both = done(client, write_manifest(tmp_path / "both.csv", rows), out)
    assert (both.reused, both.done) == (0, 1)


def test_a_file_for_the_store_is_refused_before_any_worker_is_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest = small_fleet(tmp_path, 1)
    monkeypatch.setattr("plantar.cli.fleet.run.connected", None)
    (tmp_path / "taken").write_text("")
    said = refused(capsys, "fleet", "run", manifest, "--out", tmp_path / "taken")
    assert said == f"plantar: {tmp_path / 'taken'}: is a file (valid: a folder for the results)"
