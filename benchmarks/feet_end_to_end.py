"""`plantar identify feet` beside the plain way (`plain_feet.py`), as whole processes, on the twin's logs.

Prints seconds, CPU seconds and peak memory of each, and how many times faster plantar is, best of several turns. Memory
is that of a run of its own, of a process and its copies together, where what they share counts once (Linux's PSS).

    python benchmarks/feet_end_to_end.py [--preset sensors] [--times 3]
    python benchmarks/feet_end_to_end.py --walks             nine walks instead of tilts and sways
    python benchmarks/feet_end_to_end.py --long 600          one Parquet log of 600 s at 1 kHz
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log
from plantar.motions import CAMPAIGN
from plantar.motions.gait import WALKS
from plantar.robot.model import load_robot
from plantar.twin import play_all, write_campaign
from plantar.twin.cache import folder

LOGS = CAMPAIGN[:9]  # six tilts and three manual sways
LEFT_OUT = (".velocity", ".effort")  # what neither way reads
LONG_RATE = 1000.0  # Hz


@dataclass(frozen=True)
class Spent:
    """Clock and CPU time [s] of a whole process and its copies."""

    clock: float
    cpu: float


def spent(command: Sequence[str]) -> Spent:
    """Run a command to its end; CalledProcessError where it fails."""
    start = time.perf_counter()
    process = started(command)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return Spent(time.perf_counter() - start, usage.ru_utime + usage.ru_stime)


def peak_memory(command: Sequence[str]) -> float:
    """The most memory [MB] that a command and its copies hold together, looked at every hundredth of a second."""
    process, peak = started(command), 0.0
    while process.poll() is None:
        listed = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        with suppress(OSError):
            copies = [int(number) for number in listed.read_text().split()]
            peak = max(peak, sum(map(_held, [process.pid, *copies])))
        time.sleep(0.01)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return peak


def _held(process: int) -> float:
    """Memory of one process [MB], of what it shares its part; 0 where it has ended."""
    with suppress(OSError):
        for line in Path(f"/proc/{process}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) / 1024
    return 0.0


def started(command: Sequence[str]) -> subprocess.Popen[bytes]:
    """The command at work, with its output thrown away."""
    # As installed: compiled modules are kept from one turn to the next.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["PYTHONPYCACHEPREFIX"] = str(folder() / "compiled")
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment)


def kept(preset: str, walks: bool, long: float) -> tuple[Path, list[Path]]:
    """Robot file and logs, played once and kept in the cache's folder."""
    names = WALKS[: len(LOGS)] if walks else LOGS
    out = folder() / f"feet_end_to_end_{'walks_' * walks}{preset}"
    robot = out / "robot.yaml"
    logs = [out / f"{name}.csv" for name in names]
    if not all(path.exists() for path in (robot, *logs)):
        (recordings,) = play_all(names, preset=preset)
        write_campaign(out, recordings, None, preset)
        for recording, path in zip(recordings, logs, strict=True):
            save_log(_short(recording.log), path)
    if not long:
        return robot, logs
    path = out / f"long_{long:g}.parquet"
    if not path.exists():
        save_log(_repeated(logs[0], robot, long), path)
    return robot, [path]


def _short(log: MotionLog) -> MotionLog:
    """The log without columns that neither way reads."""
    columns = {name: values for name, values in log.columns.items() if not name.endswith(LEFT_OUT)}
    return MotionLog(log.name, log.time, columns)


def _repeated(path: Path, robot: Path, seconds: float) -> MotionLog:
    """A log that begins and ends at rest in the same pose, again and again, read at LONG_RATE between its samples."""
    from plantar.logs.readers import open_log

    log = open_log(path, load_robot(robot))
    time = np.arange(0.0, seconds, 1 / LONG_RATE)
    at = np.mod(time, log.duration)
    columns = {name: np.interp(at, log.time - log.time[0], values) for name, values in log.columns.items()}
    return MotionLog("long", time, columns)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--preset", default="sensors")
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--walks", action="store_true", help="walks instead of tilts and sways")
    parser.add_argument("--long", type=float, default=0.0, help="seconds of one Parquet log at 1 kHz instead")
    chosen = parser.parse_args()
    robot, logs = kept(chosen.preset, chosen.walks, chosen.long)
    files = [str(robot), *map(str, logs)]
    out = str(robot.parent / "result")
    ways = {
        "plain": [sys.executable, str(Path(__file__).with_name("plain_feet.py")), *files],
        "plantar": [sys.executable, "-m", "plantar", "identify", "feet", *files, "--out", out, "--quiet"],
    }
    # In turns, so that what else the machine does at a time weighs on both.
    turns = [{way: spent(command) for way, command in ways.items()} for _ in range(chosen.times)]
    print(f"{'way':8} {'s':>7} {'CPU s':>7} {'MB':>6}")
    best = {way: min((turn[way] for turn in turns), key=lambda run: run.clock) for way in ways}
    for way, run in best.items():
        print(f"{way:8} {run.clock:7.2f} {run.cpu:7.2f} {peak_memory(ways[way]):6.0f}")
    plain, ours = best["plain"], best["plantar"]
    print(f"times faster: {plain.clock / ours.clock:.2f} (CPU {plain.cpu / ours.cpu:.2f})")


if __name__ == "__main__":
    main()
