"""`plantar fleet run`."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Final

from typer import Argument, BadParameter, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import end_progress, progress
from plantar.cli.fleet.report import PAGE, RUN_FILE, RUN_SCHEMA, print_summary, write_report
from plantar.feet.settings import AUTOMATIC, FeetSettings
from plantar.files import refuse_file
from plantar.fleet.cluster import connected, dashboard, seen_by_workers
from plantar.fleet.manifest import read_manifest
from plantar.fleet.places import Store, is_remote
from plantar.fleet.run import Outcome, Progress, run_fleet
from plantar.logs.readers.read_limit import SHARE
from plantar.results.io import dump_json

OUT_HELP = "Folder, or fsspec URL such as s3://bucket/fleet, for finished groups, tables and fleet.html."
MEMORY_HELP = (
    "Memory of each worker that this command starts, such as 2GB. A worker that takes more is restarted."
)
Workers = Annotated[
    int | None, Option(metavar="N", help="Processes on this machine; one per core if left out.", min=1)
]
Scheduler = Annotated[str | None, Option(help="Address of a running Dask cluster.", metavar="ADDRESS")]
WorkerMemory = Annotated[
    int | None, Option("--memory", parser=options.size_in_bytes, metavar="SIZE", help=MEMORY_HELP)
]
EVERY: Final = 5.0  # s between lines of progress where stderr is no terminal


def run(
    manifest: Annotated[
        Path, Argument(help="CSV file: group, robot, log[, role, time, unit].", metavar="MANIFEST.csv")
    ],
    out: Annotated[str, Option("--out", metavar="DIR", help=OUT_HELP)],
    workers: Workers = None,
    scheduler: Scheduler = None,
    memory: WorkerMemory = None,
    offset: options.Offset = "per-motion",
    model: options.Model = AUTOMATIC,
    wrench_delay: options.WrenchDelay = None,
    json: Annotated[bool, Option("--json", help="Print the counts as JSON.")] = False,
    quiet: Annotated[bool, Option("--quiet", "-q", help="No progress, no counts.")] = False,
) -> None:
    """`identify feet` for every group of a manifest, on all cores or on a Dask cluster; finished groups are kept.

    The same command again goes on where the last one was stopped, and computes only what is new.

    Example: plantar fleet run fleet.csv --out out/fleet
    """
    if workers is not None and scheduler is not None:
        raise BadParameter("a running cluster has workers of its own", param_hint="--workers")
    settings = FeetSettings(offset, model, wrench_delay=wrench_delay)
    groups = read_manifest(seen_by_workers(str(manifest), scheduler))
    if not is_remote(out):
        refuse_file(Path(out))
    store = Store(seen_by_workers(out, scheduler))
    step = progress(quiet)
    step(f"{len(groups)} groups; start the workers")
    room = None if memory is None else int(SHARE * memory)
    with connected(workers, scheduler, memory) as client:
        if (page := dashboard(client)) is not None:
            step(f"Dask's dashboard: {page}")
        outcome = run_fleet(groups, store, settings, client, _reporter(step), room)
    step("look at the results together")
    said = dump_json({"schema": RUN_SCHEMA, **asdict(outcome)})
    store.write(RUN_FILE, said.encode())
    summary = write_report(store)
    end_progress(quiet)
    if json:
        print(said, end="")
    elif not quiet:
        print_summary(summary)
        print(store.path(PAGE))
        print(counts(outcome))


def counts(outcome: Outcome) -> str:
    """The last line: how many groups have results, how many were there, what failed."""
    written = outcome.written
    parts = [
        f"{outcome.groups} groups: {written.finished} with results",
        f"{outcome.reused} were there already",
        f"{written.failed} failed",
        f"{written.failures} failures in failures.parquet",
    ]
    return ", ".join(parts)


def _reporter(step: Callable[[str], None]) -> Callable[[Progress], None]:
    """Shows the counts: on a terminal after each group, elsewhere now and then."""
    shown = 0.0

    def report(now: Progress) -> None:
        nonlocal shown
        finished = now.reused + now.done + now.failed >= now.total
        if not sys.stderr.isatty() and time.monotonic() - shown < EVERY and not finished:
            return
        shown = time.monotonic()
        left = "" if now.seconds_left is None else f", {_duration(now.seconds_left)} left"
        step(
            f"{now.reused + now.done} of {now.total} groups done, {now.reused} of them there already, "
            f"{now.failed} failed{left}"
        )

    return report


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
