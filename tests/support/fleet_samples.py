"""A small fleet on disk: short exact logs of the test biped, some of them broken, and a manifest."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pa_parquet

from biped import record, sway
from biped_robot import make_robot
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log

SECONDS = 5.0
HEAD = ("group", "robot", "log", "role", "time", "unit")


@cache
def short_log(seed: int) -> MotionLog:
    """A sway that is fitted in a tenth of a second."""
    return record(sway(f"log_{seed}", seed, duration=SECONDS))


def make_logs(folder: Path, count: int) -> list[str]:
    """`robot.yaml` and logs in a folder; returns the logs' names."""
    make_robot(folder)
    names = []
    for seed in range(count):
        save_log(short_log(seed), folder / f"log_{seed}.parquet")
        names.append(f"log_{seed}.parquet")
    return names


def write_manifest(path: Path, rows: Sequence[Sequence[str]]) -> Path:
    """A manifest with rows of group, robot, log, role, time, unit."""
    with open(path, "w", newline="") as handle:
        csv.writer(handle).writerows([HEAD, *rows])
    return path


def small_fleet(folder: Path, count: int) -> Path:
    """A manifest of `count` groups of one log each, two units in turn, a day apart."""
    folder.mkdir(parents=True, exist_ok=True)
    names = make_logs(folder, count)
    rows = [
        (f"g{k}", "robot.yaml", name, "fit", f"2026-03-{k + 1:02d}T10:00:00Z", f"unit {k % 2}")
        for k, name in enumerate(names)
    ]
    return write_manifest(folder / "fleet.csv", rows)


def broken_logs(folder: Path) -> dict[str, str]:
    """Ten kinds of logs that nothing can be identified from: file name -> what its error says."""
    good = short_log(0)
    table = pa.table({"time": good.time, **good.columns})
    whole = folder / "whole.parquet"
    pa_parquet.write_table(table, whole)
    content = whole.read_bytes()
    whole.unlink()
    (folder / "empty.parquet").write_bytes(b"")
    (folder / "cut.parquet").write_bytes(content[: len(content) // 2])
    (folder / "noise.parquet").write_bytes(bytes(range(256)) * 16)
    (folder / "text.csv").write_text("this is no log\n")
    (folder / "notes.docx").write_bytes(b"PK")
    pa_parquet.write_table(table.drop_columns("time"), folder / "timeless.parquet")
    pa_parquet.write_table(
        table.set_column(0, "time", table["time"].combine_chunks()[::-1]), folder / "back.parquet"
    )
    pa_parquet.write_table(table.slice(0, 20), folder / "short.parquet")
    deaf = [name for name in table.column_names if not name.startswith("wrench.")]
    pa_parquet.write_table(table.select(deaf), folder / "deaf.parquet")
    return {
        "empty.parquet": "empty", "cut.parquet": "Parquet", "noise.parquet": "Parquet", "text.csv": "",
        "notes.docx": "ending", "timeless.parquet": "time", "back.parquet": "increase", "short.parquet": "lasts",
        "deaf.parquet": "wrench",
        "gone.parquet": "does not exist",
    }  # fmt: skip
