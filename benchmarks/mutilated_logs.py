"""Real recordings, mutilated: every command must end in a result or in one clear line.

    python benchmarks/mutilated_logs.py --data DIR [--seeds 1] [--only reemc] [--mutilations cut at_10_hz]

DIR holds a folder for each robot with its `robot.yaml` and its logs. In every round each mutilation is dealt to one
recording of each robot, the next round deals it to the next one: as many rounds as recordings try every pair. Failures
are an exception, an exit that is no plain error, a warning of NumPy, a result that is no JSON, a note of an internal
error; each is shown with the line that repeats it. `identify inertia` takes a minute for a humanoid and is tried where
`--commands` names it.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet

from mutilations import MUTILATIONS, Table
from plantar.cli import COMMANDS
from plantar.cli import main as plantar

LONGEST_LINE = 1000  # characters of an error
RESULT, REFUSED, FAILED = "result", "refused", "failed"
VERBS = (
    "inspect", "identify feet", "select", "validate", "diagnose", "report", "identify joints", "identify inertia",
)  # fmt: skip


@dataclass(frozen=True)
class Recordings:
    """One robot's file and its logs."""

    name: str
    robot: Path
    logs: tuple[Path, ...]

    def table(self, place: int) -> Table:
        content = pa_csv.read_csv(self.logs[place % len(self.logs)])
        return {name: content.column(name).cast(pa.float64()).to_numpy() for name in content.column_names}


@dataclass(frozen=True)
class Outcome:
    """How a command ended, and what is wrong with that."""

    kind: str
    text: str = ""


def recordings_in(data: Path) -> list[Recordings]:
    found = []
    for robot in sorted(data.glob("*/robot.yaml")):
        logs = sorted(path for path in robot.parent.iterdir() if path.name.endswith((".csv", ".csv.gz")))
        found.append(Recordings(robot.parent.name, robot, tuple(logs)))
    return found


def attempt(arguments: Sequence[str]) -> Outcome:
    """One command in this process."""
    said, printed = io.StringIO(), io.StringIO()
    try:
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            with contextlib.redirect_stderr(said), contextlib.redirect_stdout(printed):
                plantar([str(argument) for argument in arguments])
        code: object = 0
    except SystemExit as end:
        code = end.code or 0
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        return Outcome(FAILED, _trace(error))
    if warned:
        lines = [f"{warning.filename}:{warning.lineno}: {warning.message}" for warning in warned]
        return Outcome(FAILED, "warns: " + " | ".join(dict.fromkeys(lines)))
    if code == 0:
        return Outcome(RESULT)
    last = said.getvalue().strip("\n").rsplit("\n", 1)[-1]
    if code != 1:
        return Outcome(FAILED, f"exit {code}: {last}")
    if arguments[0] == "inspect" and "problem: " in printed.getvalue():
        return Outcome(REFUSED, printed.getvalue().split("problem: ", 1)[1].split("\n  ", 1)[0])
    plain = last.startswith("plantar: ") and len(last) <= LONGEST_LINE
    return Outcome(REFUSED if plain else FAILED, last)


def _trace(error: BaseException) -> str:
    """Where in plantar it broke, innermost first, and why."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if "/plantar/" in frame.filename]
    places = [f"{frame.filename.rsplit('/plantar/', 1)[1]}:{frame.lineno} {frame.name}" for frame in frames]
    reason = " ".join(f"{type(error).__name__}: {error}".split())
    return f"{reason}; " + " < ".join(places[:-6:-1])


def wrong_with(result: Path) -> str:
    """What is wrong with a result.json, empty where nothing is."""

    def refuse(constant: str) -> float:
        raise ValueError(f"{result.name} holds {constant}, which is no JSON")

    try:
        content = json.loads(result.read_text(), parse_constant=refuse)
    except ValueError as error:
        return str(error)
    internal = [note["text"] for note in content["notes"] if note["code"] == "internal_error"]
    return "; ".join(internal)


def commands(robot: Path, logs: Sequence[Path], clean: Path, folder: Path) -> Iterator[list[str]]:
    """The arguments of every command, as long as what it reads is there. `clean`: a result of whole recordings."""
    paths, result = [str(path) for path in logs], folder / "feet" / "result.json"
    yield ["inspect", str(robot), *paths]
    yield ["identify", "feet", str(robot), *paths, "--out", str(result.parent)]
    yield ["select", str(robot), *paths]
    for existing in (result, clean):
        if existing.exists():
            yield ["validate", str(existing), str(robot), *paths]
    if result.exists():
        yield ["diagnose", str(result)]
        yield ["report", str(result)]
    for what in ("joints", "inertia"):
        yield ["identify", what, str(robot), *paths, "--out", str(folder / what)]


def write(table: Table, path: Path) -> Path:
    pa_parquet.write_table(pa.table(table), path)
    return path


def trial(
    source: Recordings,
    mutilation: str,
    place: int,
    seed: int,
    clean: Path,
    folder: Path,
    verbs: Sequence[str],
) -> Iterator[tuple[str, Outcome, float]]:
    """Every command on one mutilated recording, or set of recordings: its verb, its outcome, seconds."""
    rng = np.random.default_rng([seed, place, *mutilation.encode()])
    tables = [source.table(place + step) for step in range(min(3, len(source.logs)))]
    mutilated = MUTILATIONS[mutilation](tables, rng)
    logs = [write(table, folder / f"log_{i}.parquet") for i, table in enumerate(mutilated)]
    for arguments in commands(source.robot, logs, clean, folder) if logs else ():
        verb = " ".join(arguments[: 2 if arguments[0] == "identify" else 1])
        if verb not in verbs:
            continue
        start = time.perf_counter()
        outcome = attempt(arguments)
        if outcome.kind == RESULT and arguments[0] == "identify":
            problem = wrong_with(Path(arguments[-1]) / "result.json")
            outcome = Outcome(FAILED, problem) if problem else outcome
        yield verb, outcome, time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=1, help="rounds")
    parser.add_argument("--first", type=int, default=0, help="the first round")
    parser.add_argument("--only", nargs="*", help="robots")
    parser.add_argument("--mutilations", nargs="*", default=list(MUTILATIONS), choices=list(MUTILATIONS))
    parser.add_argument("--commands", nargs="*", default=list(VERBS[:-1]), choices=VERBS)
    parser.add_argument(
        "--keep", type=Path, help="folder for the mutilated logs; a temporary one if left out"
    )
    parser.add_argument("--verbose", action="store_true", help="name every outcome")
    given = parser.parse_args()
    for module, _ in COMMANDS.values():
        import_module(f"plantar.cli.{module}")
    counts: defaultdict[tuple[str, str], Counter[str]] = defaultdict(Counter)
    with contextlib.ExitStack() as stack:
        base = given.keep or Path(stack.enter_context(tempfile.TemporaryDirectory()))
        for source in recordings_in(given.data):
            if given.only and source.name not in given.only:
                continue
            clean = base / f"{source.name}_clean"
            whole = [str(path) for path in source.logs[:2]]
            attempt(["identify", "feet", str(source.robot), *whole, "--out", str(clean), "--quiet"])
            for seed in range(given.first, given.first + given.seeds):
                for mutilation in given.mutilations:
                    place = (list(MUTILATIONS).index(mutilation) + seed) % len(source.logs)
                    folder = base / f"{source.name}_{mutilation}_{seed}"
                    folder.mkdir(parents=True, exist_ok=True)
                    again = (f"python benchmarks/mutilated_logs.py --data {given.data} --only {source.name} --first "
                             f"{seed} --mutilations {mutilation}")  # fmt: skip
                    run = trial(
                        source, mutilation, place, seed, clean / "result.json", folder, given.commands
                    )
                    for verb, outcome, seconds in run:
                        counts[source.name, verb][outcome.kind] += 1
                        counts["all", mutilation][outcome.kind] += 1
                        if outcome.kind == FAILED or given.verbose:
                            where = f"{source.name} {source.logs[place].name} {mutilation} {seed}: {verb}"
                            print(f"{outcome.kind:8} {seconds:5.1f} s {where}: {outcome.text}", flush=True)
                        if outcome.kind == FAILED:
                            print(f"         again: {again} --verbose", flush=True)
    print(f"{'':40} {RESULT:>8} {REFUSED:>8} {FAILED:>8}")
    for (first, second), found in counts.items():
        print(
            f"{first + ' ' + second:40} " + " ".join(f"{found[kind]:8}" for kind in (RESULT, REFUSED, FAILED))
        )
    sys.exit(any(found[FAILED] for found in counts.values()))


if __name__ == "__main__":
    main()
