"""`plantar fleet inertia`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Argument

from plantar.cli.console import options
from plantar.cli.console.terminal import progress
from plantar.cli.fleet.run import Scheduler, WorkerMemory, Workers
from plantar.cli.identify import identification
from plantar.cli.identify.dynamics_tables import print_inertia
from plantar.errors import PlantarError
from plantar.files import refuse_file
from plantar.fleet.cluster import connected, seen_by_workers
from plantar.fleet.inertia import inertia_over
from plantar.fleet.manifest import read_manifest
from plantar.report import write_dynamics_report
from plantar.results.dynamics import URDF
from plantar.whole_body.settings import DynamicsSettings


def run(
    manifest: Annotated[Path, Argument(help="CSV file as for `fleet run`.", metavar="MANIFEST.csv")],
    out: options.Out,
    workers: Workers = None,
    scheduler: Scheduler = None,
    memory: WorkerMemory = None,
    cutoff: options.Cutoff = DynamicsSettings.cutoff,
    as_recorded: options.AsRecorded = False,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """`identify inertia` on all logs of a manifest with role fit, for one robot file: R factors that add up (eq. 2).

    Example: plantar fleet inertia fleet.csv --out out/inertia
    """
    refuse_file(out)
    groups = read_manifest(seen_by_workers(str(manifest), scheduler))
    robots = list(dict.fromkeys(group.robot for group in groups))
    if len(robots) > 1:
        message = f"names {len(robots)} robot files"
        raise PlantarError(message, path=manifest, column="robot", valid="one for `fleet inertia`")
    logs = list(dict.fromkeys(log.place for group in groups for log in group.logs if log.role == "fit"))
    step = progress(quiet)
    with connected(workers, scheduler, memory) as client:
        result = inertia_over(client, robots[0], logs, DynamicsSettings(cutoff, as_recorded), step)
    identification.keep(
        result, out, write_dynamics_report, print_inertia, json=json, quiet=quiet, beside=[URDF]
    )
