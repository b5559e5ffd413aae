"""Mutation testing: does a test notice when the source says something else?

Each mutant stands alone in a copy of the source in a temporary folder; pytest runs the tests of its room against the
copy, which PYTHONPATH puts before the installed package. Nothing is changed in place. A mutant is caught when a test
fails or takes far longer than without it; it is stale when the text that it replaces has left the source.

    python tests/mutants/run.py [--list NAME] [--only TEXT] [--near | --tests PATH ...]
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import TypeVar

from lists import LISTS
from mutant import Mutant, StaleMutant

Item = TypeVar("Item")
Found = TypeVar("Found")
Tests = tuple[str, ...]  # folders and files below `tests`

ROOT = Path(__file__).resolve().parents[2]
LEAST_CAUGHT = 0.85
PATIENCE, LEAST_PATIENCE = 20.0, 300.0  # usual seconds of the tests, and seconds: beyond, a mutant hangs
PASSED, NOTICED = 0, (1, 2, None)  # pytest's codes: a test failed, one could not be imported; None: it hangs
# An editable install finds its modules before PYTHONPATH does.
ONLY_THE_COPY = """\
import sys
sys.meta_path[:] = [each for each in sys.meta_path if "Redirecting" not in type(each).__name__]
"""


class BrokenRun(Exception):
    """The tests fail without any mutant, or do not run at all: nothing can be said about mutants."""


@dataclass(frozen=True)
class Outcome:
    """What pytest said: its exit code, None where it was stopped for taking too long, and its last lines."""

    code: int | None
    seconds: float
    said: str

    @property
    def noticed_by(self) -> str:
        """The first test that failed."""
        failed = [line for line in self.said.splitlines() if line.startswith(("FAILED", "ERROR"))]
        return failed[0].split(" ")[1] if failed else "the clock" if self.code is None else "the import"


class Copy:
    """A copy of the package, with its native part, for one mutant at a time."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.package = folder, folder / "plantar"
        shutil.copytree(ROOT / "src" / "plantar", self.package, ignore=shutil.ignore_patterns("__pycache__"))
        native = importlib.util.find_spec("plantar._core")
        if native is None or native.origin is None:
            raise BrokenRun("plantar is not installed (valid: make test)")
        if not (self.package / Path(native.origin).name).exists():
            shutil.copy(native.origin, self.package)
        (folder / "sitecustomize.py").write_text(ONLY_THE_COPY)

    def source(self, file: str) -> Path:
        """The copied file; BrokenRun where Python would import another one."""
        path = self.package / file
        module = ".".join(("plantar", *Path(file).with_suffix("").parts))
        find = f"import importlib.util; print(importlib.util.find_spec({module!r}).origin)"
        told = subprocess.run(
            [sys.executable, "-c", find], capture_output=True, text=True, env=self._environment
        )
        if Path(told.stdout.strip()) != path:
            raise BrokenRun(
                f"{module} is imported from {told.stdout.strip() or told.stderr}, not from the copy"
            )
        return path

    def tested(self, tests: Sequence[str], patience: float | None = None) -> Outcome:
        """The outcome of `tests`, up to the first that fails, against the copy as it is."""
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=no", "-rfE"]
        began = time.monotonic()
        with subprocess.Popen(
            [*command, *(f"tests/{name}" for name in tests)], cwd=ROOT, env=self._environment,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        ) as running:  # fmt: skip
            try:
                said, _ = running.communicate(timeout=patience)
                code: int | None = running.returncode
            except subprocess.TimeoutExpired:
                running.kill()
                said, code = running.communicate()[0], None
        return Outcome(code, time.monotonic() - began, said)

    @property
    def _environment(self) -> dict[str, str]:
        paths = os.pathsep.join(filter(None, [str(self.folder), os.environ.get("PYTHONPATH")]))
        threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        return {**os.environ, **threads, "PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}


def tried(mutant: Mutant, copy: Copy, tests: Sequence[str], patience: float) -> Outcome:
    """What the tests say of a mutant; the copy is whole again afterwards."""
    source = copy.source(mutant.file)
    text = source.read_text()
    try:
        source.write_text(mutant.changed(text))
        return copy.tested(tests, patience)
    finally:
        source.write_text(text)


def side_by_side(work: Callable[[Item], Found], items: Sequence[Item], jobs: int) -> list[Found]:
    """What `work` finds of each item. Where it raises, or the user interrupts, what has not begun does not begin."""
    pool = ThreadPoolExecutor(jobs)
    try:
        return list(pool.map(work, items))
    finally:
        pool.shutdown(cancel_futures=True)


def usual_seconds(sets: Sequence[Tests], copies: SimpleQueue[Copy], jobs: int) -> dict[Tests, float]:
    """How long each set of tests takes on the source as it is. BrokenRun where one does not pass."""

    def one(tests: Tests) -> float:
        copy = copies.get()
        try:
            outcome = copy.tested(tests)
        finally:
            copies.put(copy)
        if outcome.code != PASSED:
            raise BrokenRun(f"without a mutant: tests {' '.join(tests)} do not pass:\n{outcome.said}")
        return outcome.seconds

    return dict(zip(sets, side_by_side(one, sets, jobs), strict=True))


def survivors_of(judged: Mapping[Mutant, Tests], jobs: int) -> list[Mutant]:
    """Try all mutants with their tests, saying of each what became of it; those that no test notices."""
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        copies: SimpleQueue[Copy] = SimpleQueue()
        for place in range(jobs):
            copies.put(Copy(Path(folder) / str(place)))
        seconds = usual_seconds(list(dict.fromkeys(judged.values())), copies, jobs)

        def caught(mutant: Mutant) -> bool:
            tests, copy = judged[mutant], copies.get()
            try:
                outcome = tried(mutant, copy, tests, max(LEAST_PATIENCE, PATIENCE * seconds[tests]))
            finally:
                copies.put(copy)
            if outcome.code not in (PASSED, *NOTICED):
                raise BrokenRun(f"{mutant.name}: pytest ended with {outcome.code}:\n{outcome.said}")
            passed = outcome.code == PASSED
            print(
                f"SURVIVED  {mutant.name}" if passed else f"caught    {mutant.name}: {outcome.noticed_by}",
                flush=True,
            )
            return not passed

        found = side_by_side(caught, list(judged), jobs)
    return [mutant for mutant, noticed in zip(judged, found, strict=True) if not noticed]


def main() -> int:
    """0 where at least the share asked for is caught and no mutant is stale."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--list", choices=LISTS, action="append", dest="lists", help="all lists where left out"
    )
    parser.add_argument("--only", default="", help="mutants whose name holds this text")
    parser.add_argument(
        "--near", action="store_true", help="only the tests in the folder that mirrors the source's"
    )
    parser.add_argument(
        "--tests", nargs="+", help="these folders or files below tests, instead of the room's"
    )
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least", type=float, default=LEAST_CAUGHT, help="share that must be caught")
    asked = parser.parse_args()
    every = [mutant for name in asked.lists or LISTS for mutant in LISTS[name] if asked.only in mutant.name]
    fresh, stale = [], 0
    for mutant in every:
        try:
            mutant.changed((ROOT / "src" / "plantar" / mutant.file).read_text())
            fresh.append(mutant)
        except (StaleMutant, FileNotFoundError) as error:
            print(f"STALE     {mutant.name}  {error}")
            stale += 1
    if not fresh:
        print("no mutant to try")
        return 2
    try:
        named = tuple(asked.tests or ())
        judged = {mutant: named or mutant.judges(ROOT / "tests", near=asked.near) for mutant in fresh}
        survivors = survivors_of(judged, asked.jobs)
    except BrokenRun as error:
        print(error, file=sys.stderr)
        return 2
    share = 1 - len(survivors) / len(fresh)
    print(f"{len(fresh) - len(survivors)} of {len(fresh)} caught ({100 * share:.0f} %), {stale} stale")
    return int(stale > 0 or share < asked.least)


if __name__ == "__main__":
    sys.exit(main())
