"""What a fleet costs: throughput of one and two workers, Dask's part of the time, memory; and runs that are killed.

python benchmarks/fleet.py throughput --groups 60          # one 44 s log a group, two robots
python benchmarks/fleet.py driver --groups 100 1000 10000  # small logs: memory of the driver
python benchmarks/fleet.py kills --times 30                # kill -9 at random times, tables compared to the bit
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil
import pyarrow as pa
import pyarrow.parquet as pa_parquet

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "support"))

KINDS = ("worker", "workers", "driver")  # what is killed, in turn
MEGA = 2**20


@dataclass
class Run:
    """One `plantar fleet run`: its counts, and peaks of memory [bytes] of the driver and of the largest worker."""

    counts: dict[str, float]
    driver: int = 0
    worker: int = 0


def command(manifest: Path, out: Path, workers: int, *options: str) -> list[str]:
    start = [sys.executable, "-m", "plantar", "fleet", "run", str(manifest), "--out", str(out)]
    return [*start, "--workers", str(workers), "--json", *options]


def children(parent: int) -> list[int]:
    """The processes below a process."""
    try:
        return [child.pid for child in psutil.Process(parent).children(recursive=True)]
    except psutil.NoSuchProcess:
        return []


def peak(process: int) -> int:
    """Most memory that a process has held [bytes]; 0 where it is gone."""
    try:
        lines = Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM")), 0)


def measured(words: list[str]) -> Run:
    """A run to its end, watched."""
    started = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    run = Run({})
    over = threading.Event()

    def watch() -> None:
        while not over.wait(0.2):
            run.driver = max(run.driver, peak(started.pid))
            run.worker = max([run.worker, *map(peak, children(started.pid))])

    watcher = threading.Thread(target=watch)
    watcher.start()
    printed, _ = started.communicate()
    over.set()
    watcher.join()
    run.counts = json.loads(printed)
    return run


def throughput(groups: int, rounds: int) -> None:
    from plantar.twin.fleet import write_fleet

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        manifest = write_fleet(
            folder, 2, groups // 2, motion="Tilt3", preset="sensors", seed=0, progress=lambda _: None
        )
        rates: dict[int, list[float]] = {1: [], 2: []}
        for number in range(rounds):
            for workers in rates:
                run = measured(command(manifest, folder / f"out_{number}_{workers}", workers))
                seconds, worked = run.counts["seconds"], run.counts["worked"]
                rates[workers].append(groups / seconds)
                outside = 100 * (1 - worked / (workers * seconds))
                print(
                    f"{workers} workers: {groups} groups in {seconds:.1f} s, {groups / seconds:.2f} a second; "
                    f"{outside:.1f} % of the workers' time outside of groups; peak memory: driver "
                    f"{run.driver / MEGA:.0f} MB, worker {run.worker / MEGA:.0f} MB; load {os.getloadavg()[0]:.1f}",
                    flush=True,
                )
        print(f"two workers / one: {np.median(rates[2]) / np.median(rates[1]):.2f}")


def small_logs(folder: Path, groups: int) -> Path:
    """A manifest of small logs that differ in one number, so that each is a unit of its own."""
    from fleet_samples import make_logs, write_manifest

    (first,) = make_logs(folder, 1)
    table = pa_parquet.read_table(folder / first)
    place = table.schema.get_field_index("joint.neck.position")
    rows = []
    for number in range(groups):
        path = folder / f"small_{number:05d}.parquet"
        column = table.column(place).to_numpy() + 1e-9 * number
        pa_parquet.write_table(table.set_column(place, "joint.neck.position", pa.array(column)), path)
        rows.append(
            (f"g{number}", "robot.yaml", path.name, "", f"2026-01-{1 + number % 28:02d}", f"u{number % 50}")
        )
    return write_manifest(folder / "fleet.csv", rows)


def driver(sizes: list[int]) -> None:
    for groups in sizes:
        with tempfile.TemporaryDirectory() as name:
            manifest = small_logs(Path(name), groups)
            options = ("--model", "kelvin_voigt", "--wrench-delay", "0")
            run = measured(command(manifest, Path(name, "out"), 2, *options))
            print(
                f"{groups} groups in {run.counts['seconds']:.0f} s: driver {run.driver / MEGA:.0f} MB, "
                f"worker {run.worker / MEGA:.0f} MB",
                flush=True,
            )


def kills(times: int, groups: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    options = ("--model", "kelvin_voigt")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        manifest = small_logs(folder, groups)
        before = time.monotonic()
        measured(command(manifest, folder / "undisturbed", 2, *options))
        length = time.monotonic() - before
        expected, same, again = digest(folder / "undisturbed"), 0, 0
        for number in range(times):
            kind, out = KINDS[number % len(KINDS)], folder / f"killed_{number}"
            started = subprocess.Popen(
                command(manifest, out, 2, *options), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
            time.sleep(random.uniform(0.15, 0.95) * length)
            finished = units(out)
            end(started, kind)
            if kind == "driver":
                time.sleep(0.5)  # its workers end by themselves
                finished = units(out)
            measured(command(manifest, out, 2, *options))
            after = units(out)
            again += sum(after.get(path) != written for path, written in finished.items())
            same += digest(out) == expected
            print(f"{number + 1}. {kind} killed with {len(finished)} of {groups} groups done", flush=True)
        print(f"{same} of {times} tables the same to the bit; {again} finished groups computed again")


def end(started: subprocess.Popen[bytes], kind: str) -> None:
    """Kill -9 of one worker, of all, or of the driver; a driver that lost workers only runs to its end."""
    workers = children(started.pid)
    if kind == "driver" or not workers:
        started.kill()
        started.wait()
        return
    for process in workers if kind == "workers" else workers[-1:]:
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            continue
    started.wait()


def units(out: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in (out / "units").rglob("*.json")}


def digest(out: Path) -> str:
    content = (out / "results.parquet").read_bytes() + (out / "failures.parquet").read_bytes()
    return hashlib.sha256(content).hexdigest()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=["throughput", "driver", "kills"])
    parser.add_argument("--groups", type=int, nargs="+", default=[60])
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--times", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    if asked.what == "throughput":
        throughput(asked.groups[0], asked.rounds)
    elif asked.what == "driver":
        driver(asked.groups)
    else:
        kills(asked.times, asked.groups[0], asked.seed)


if __name__ == "__main__":
    main()
