"""What a fleet's tables say, as it is kept: every alarm, effect, reason and number of its summary, and each history."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fleet_samples import broken_logs, make_logs, write_manifest
from fleet_tables import changing_fleet, failures, results, row
from kept_texts import assert_as_kept, described, lines_of
from plantar.cli.fleet.report import print_summary, write_report
from plantar.cli.fleet.run import counts
from plantar.feet.settings import FeetSettings
from plantar.fleet.manifest import read_manifest
from plantar.fleet.places import Store
from plantar.fleet.run import Progress, run_fleet
from plantar.fleet.statistics.changes import history_of
from plantar.fleet.statistics.random_effects import mean_of, nested_means
from plantar.fleet.statistics.trend import trend_of
from plantar.fleet.summary import summary_of
from plantar.fleet.tables import read_failures, read_groups, read_results
from plantar.twin.fleet import stories

KEPT = Path(__file__).parent / "kept"
WRONG = failures(
    ("a", "/a.csv", "/a.csv, column 'x', t = 3.5 s: bad"), ("b", "/b.csv", "/b.csv, column 'x', t = 9 s: bad"),
    ("c", "", "the logs have no foot in common"),
)  # fmt: skip


def test_a_summary_is_as_it_is_kept(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In memory, in its file and on the terminal."""
    random = np.random.default_rng(3)
    other = [
        row(f"unit {unit}", 9 * week, foot, axis, 300 * (1 + 0.1 * unit) * np.exp(0.02 * random.normal()),
            verdict="weak" if week == 4 else "usable", name="damping" if axis == "roll" else "stiffness")
        for unit in range(4) for week in range(9) for foot in ("left", "right") for axis in ("pitch", "roll")
    ]  # fmt: skip
    other[5] |= {"value": 900.0}
    other[9] |= {"value": None, "time": None}
    found = summary_of(results(other), WRONG, 0.5)
    monkeypatch.setenv("COLUMNS", "150")
    print_summary(found)
    print_summary(summary_of(changing_fleet(), WRONG, 0.5))
    text = described(found) + lines_of(found.to_dict(), "plantar") + capsys.readouterr().out
    assert_as_kept(text, KEPT / "summary.txt", share=1e-5)


def test_histories_and_effects_are_as_they_are_kept() -> None:
    random, time = (
        np.random.default_rng(4),
        np.cumsum(np.random.default_rng(5).integers(1, 4, 60)).astype(float),
    )
    noise, weights = 0.01 * random.normal(size=60), 1 + (np.arange(60) % 3)
    made = {
        "still": noise, "step": noise + 0.05 * (time > 60), "trend": noise + 0.001 * time,
        "outlier": noise + 0.1 * (np.arange(60) == 31), "two steps": noise + 0.04 * (time > 40) - 0.06 * (time > 90),
        "coarse": np.round(noise, 2), "short": noise[:5], "fades": noise + 0.05 * np.exp(-time / 20),
    }  # fmt: skip
    told: dict[str, object] = {"stories": stories(6, 90, 2, 0.05)}
    for name, values in made.items():
        size = len(values)
        told[name] = history_of(time[:size], values, weights[:size].astype(float), 0.5)
        told[f"{name}, as a line"] = trend_of(time[:size], values, weights[:size].astype(float))
    units, days = [place % 4 for place in range(12)], [place // 4 % 2 for place in range(12)]
    told["means"] = nested_means(made["step"][24:36], 1e-4 * weights[:12], days, units)
    told["mean"] = mean_of(made["step"][24:36], 1e-4 * weights[:12], 2e-4)
    assert_as_kept(described(told), KEPT / "histories.txt", share=1e-5)


ROWS = (
    ("a", "robot.yaml", "log_0.parquet", "fit", "2026-03-01T10:00:00Z", "unit 1"),
    ("a", "robot.yaml", "log_1.parquet", "validate", "2026-03-01T10:00:00Z", "unit 1"),
    ("b", "robot.yaml", "log_1.parquet", "fit", "2026-03-02T11:30:00Z", "unit 2"),
    ("b", "robot.yaml", "empty.parquet", "fit", "2026-03-02T11:30:00Z", "unit 2"),
    ("b", "robot.yaml", "gone.parquet", "validate", "2026-03-02T11:30:00Z", "unit 2"),
    ("c", "robot.yaml", "log_2.parquet", "", "", ""),
    ("c", "robot.yaml", "deaf.parquet", "", "", ""),
    ("c", "robot.yaml", "short.parquet", "validate", "", ""),
    ("e", "robot.yaml", "timeless.parquet", "", "2026-03-04", "unit 1"),
    ("f", "nowhere.yaml", "log_0.parquet", "", "", "unit 2"),
    ("g", "again.yaml", "log_2.parquet", "", "2026-03-05T01:00:00+02:00", "unit 2"),
)  # fmt: skip


def test_a_run_is_as_it_is_kept(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Groups of which logs are broken, gone, or only to validate: twice, then with all logs there; tables and words."""
    make_logs(tmp_path, 3)
    broken_logs(tmp_path)
    robot, store = tmp_path / "robot.yaml", Store(str(tmp_path / "out"))
    (tmp_path / "again.yaml").write_text(robot.read_text() + "# of another robot\n")
    groups = read_manifest(write_manifest(tmp_path / "fleet.csv", ROWS))
    settings, told = FeetSettings(model="kelvin_voigt", wrench_delay=0.0), dict[str, Any]()
    for run in ("first", "second", "with all logs"):
        if run == "with all logs":
            (tmp_path / "log_0.parquet").rename(tmp_path / "gone.parquet")
            monkeypatch.setattr("plantar.fleet.run.QUEUED", 1)
        seen: list[Progress] = []
        outcome = run_fleet(groups, store, settings, client, seen.append)
        rows = [asdict(row) | {"key": len(row.key)} for row in read_groups(store)]
        summary = write_report(store, 2.0)
        found, last = read_results(store).to_pylist(), seen[-1]
        told[run] = {
            "reused": outcome.reused, "done": outcome.done, "written": outcome.written, "groups": rows,
            "last": [last.total, last.reused, last.done, last.failed], "units": len(store.names("units")),
            "results": found if run == "first" else np.array([row["value"] for row in found]),
            "failures": read_failures(store).to_pylist(), "counts": counts(outcome),
            "alarms": [alarm.text for alarm in summary.alarms],
            "reasons": [(one.count, one.example) for one in summary.failures],
        }  # fmt: skip
    assert_as_kept(described(told).replace(str(tmp_path), "FOLDER"), KEPT / "run.txt", share=1e-5)
