"""`plantar identify feet`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import numpy as np
from typer import Option

from plantar.cli.console import options
from plantar.cli.console.terminal import progress
from plantar.cli.identify import identification
from plantar.cores import begun
from plantar.feet.settings import AUTOMATIC, DEFAULT_CUTOFF, FeetSettings
from plantar.files import refuse_file, write_text
from plantar.logs.freed_memory import keep_freed
from plantar.logs.inputs import open_in_turn, read_ahead, robot_of

CUTOFF_HELP = (
    f"Cut-off of the zero-phase low-pass filter on angles and torques, in Hz. If left out: {DEFAULT_CUTOFF:g}, or less "
    "where angle and torque of a walk are not coherent up to there."
)
WINDOW_HELP = "Use only deflections up to this many degrees from the resting pose."


def run(
    robot: options.Robot,
    logs: options.Logs,
    out: options.Out,
    validate: options.Validate = None,
    offset: options.Offset = "per-motion",
    model: options.Model = AUTOMATIC,
    wrench_delay: options.WrenchDelay = None,
    cutoff: Annotated[float | None, Option(help=CUTOFF_HELP, metavar="HZ", min=0.1)] = None,
    window: Annotated[float | None, Option(help=WINDOW_HELP, metavar="DEG", min=0.01)] = None,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Stiffness, damping and offset of each foot, in pitch and roll, from logs of a standing or walking robot.

    Example: plantar identify feet talos.yaml sway_*.csv --validate squat.csv --out out/feet
    """
    reach = None if window is None else float(np.radians(window))
    settings = FeetSettings(offset, model, cutoff, window=reach, wrench_delay=wrench_delay)
    refuse_file(out)
    keep_freed()
    paths, show = [*logs, *(validate or ())], progress(quiet)
    with begun(partial(read_ahead, paths, memory)) as ahead:  # while all that works on logs is imported
        from plantar.feet.prepare import prepare_all
        from plantar.signals.thinning import kept_size

        known = robot_of(robot)
        read = open_in_turn(paths, known, kept_size, memory, ahead())
    ready = prepare_all(known, read[: len(logs)], read[len(logs) :], settings, show, _get_rest_ready)
    from plantar.cli.identify.feet_tables import print_feet
    from plantar.feet.identify import fit_prepared
    from plantar.report.feet import feet_page

    result = fit_prepared(known, ready, show)
    with begun(partial(feet_page, result)) as page:  # it is drawn while the numbers are saved

        def report(saved: Path) -> Path:
            path = saved.with_name("report.html")
            write_text(path, page())
            return path

        identification.keep(result, out, report, print_feet, json=json, quiet=quiet)


def _get_rest_ready() -> None:
    """Import what comes behind the logs, and make the report ready: cores wait for the last log."""
    import pyarrow.parquet  # noqa: F401

    import plantar.cli.identify.feet_tables
    import plantar.feet.identify  # noqa: F401
    from plantar.report.feet import get_report_ready

    get_report_ready()
