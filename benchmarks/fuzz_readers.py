"""Damaged logs, by the thousand: every reader must give a log or one clear line, in bounded time and memory.

    python benchmarks/fuzz_readers.py [--count 20000] [--only mcap ros1 ...] [--seed 0]

Every format's file of a short recording is damaged (bits, cuts, runs of zeros, lengths that lie, pieces moved
or repeated) and opened. A reader runs in a process of its own under a limit on memory; a Python error that is
not plantar's, a crash, or a file that takes longer than the limit is a failure, shown with its seed.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import resource
import shutil
import signal
import struct
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))

from biped import record, sway
from biped_robot import make_robot
from log_formats import WRITERS
from plantar.errors import PlantarError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.robot.model import RobotModel

MEMORY = 4 * 2**30  # bytes of address space beyond what the process starts with
SECONDS = 10  # for one file
LENGTHS = (0, 1, 3, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, 2**40, 2**63 - 1, 2**64 - 1)


def damage(content: bytes, rng: np.random.Generator) -> bytes:
    """The content with one to four kinds of damage."""
    data = bytearray(content)
    for _ in range(rng.integers(1, 5)):
        if not data:
            return b""
        at = int(rng.integers(len(data)))
        if rng.random() < 0.4:
            at = min(at, int(rng.integers(1, 600)))  # headers deserve more
        span = int(rng.integers(1, 200))
        kind = rng.integers(8)
        if kind == 0:
            data[at % len(data)] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            data = data[:at]
        elif kind == 2:
            data[at : at + span] = bytes(min(span, len(data) - at))
        elif kind == 3:
            data[at : at + span] = rng.bytes(min(span, len(data) - at))
        elif kind == 4:
            form = "<I" if rng.random() < 0.5 else "<Q"
            value = LENGTHS[rng.integers(len(LENGTHS))] % (2**32 if form == "<I" else 2**64)
            packed = struct.pack(form, value)
            data[at : at + len(packed)] = packed
        elif kind == 5:
            piece = data[at : at + span]
            data[at:at] = piece * int(rng.integers(1, 4))
        elif kind == 6:
            del data[at : at + span]
        else:
            other = int(rng.integers(len(data)))
            data[at : at + span] = data[other : other + span]
    return bytes(data)


class TooSlow(Exception):
    """The reader took longer than it may."""


def _alarm(_: int, __: FrameType | None) -> None:
    raise TooSlow


def prepare(name: str, folder: Path) -> tuple[Path, list[Path], RobotModel]:
    """What to open, its files, and the robot file that goes with it."""
    log = record(sway("log", duration=1.2))
    source = folder / name
    source.mkdir(parents=True)
    path, columns = WRITERS[name](log, source)
    files = sorted(part for part in source.rglob("*") if part.is_file())
    return path, files, make_robot(folder / f"{name}_robot", columns=columns)


def attack(name: str, folder: Path, seeds: Iterator[int]) -> dict[str, object]:
    """Damage one format's files once per seed; counts of what came of it, and the first failures."""
    path, files, robot = prepare(name, folder)
    whole = {file: file.read_bytes() for file in files}
    counts = {"read": 0, "refused": 0, "failed": 0}
    failures: list[str] = []
    slowest = 0.0
    signal.signal(signal.SIGALRM, _alarm)
    for seed in seeds:
        rng = np.random.default_rng(seed)
        target = files[rng.integers(len(files))]
        target.write_bytes(damage(whole[target], rng))
        start = time.perf_counter()
        try:
            signal.alarm(SECONDS)
            log = open_log(path, robot if rng.random() < 0.8 else None)
            signal.alarm(0)
            assert isinstance(log, MotionLog)
            assert np.all(np.diff(log.time) > 0)
            counts["read"] += 1
        except PlantarError as error:
            signal.alarm(0)
            counts["refused"] += 1
            if "\n" in str(error) or len(str(error)) > 1000:
                counts["failed"] += 1
                failures.append(f"seed {seed}: not one short line: {str(error)[:200]!r}")
        except BaseException:
            signal.alarm(0)
            counts["failed"] += 1
            failures.append(f"seed {seed}: {traceback.format_exc(limit=-3)}")
        slowest = max(slowest, time.perf_counter() - start)
        target.write_bytes(whole[target])
        if len(failures) >= 5:
            break
    return {**counts, "slowest_s": round(slowest, 2), "failures": failures}


def _worker(name: str, first: int, count: int, results: multiprocessing.Queue[dict[str, object]]) -> None:
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
    folder = Path(tempfile.mkdtemp(dir="/dev/shm" if Path("/dev/shm").is_dir() else None))
    try:
        results.put(attack(name, folder, iter(range(first, first + count))))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def run(name: str, first: int, count: int) -> dict[str, object]:
    """One format in a process of its own; a process that dies is a failure."""
    context = multiprocessing.get_context("spawn")
    results: multiprocessing.Queue[dict[str, object]] = context.Queue()
    process = context.Process(target=_worker, args=(name, first, count, results))
    process.start()
    process.join()
    if process.exitcode != 0 or results.empty():
        return {"failed": 1, "failures": [f"the process ended with {process.exitcode}"]}
    return results.get()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", nargs="*", default=list(WRITERS))
    arguments = parser.parse_args()
    failed = False
    for name in arguments.only:
        start = time.perf_counter()
        outcome = run(name, arguments.seed, arguments.count)
        failures = outcome.pop("failures", [])
        print(
            json.dumps({"format": name, **outcome, "seconds": round(time.perf_counter() - start)}), flush=True
        )
        for failure in failures if isinstance(failures, list) else []:
            print(failure, flush=True)
            failed = True
    sys.exit(failed)


if __name__ == "__main__":
    main()
