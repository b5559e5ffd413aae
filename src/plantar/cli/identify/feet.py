"""`plantar identify feet`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from plantar.cli.console.delay import WrenchDelay
from plantar.cli.console.memory import Memory
from plantar.cli.console.terminal import progress
from plantar.cli.identify import identification
from plantar.cores import begun
from plantar.feet.settings import AUTOMATIC, DEFAULT_CUTOFF, MODEL_CHOICES, FeetSettings, OffsetRule
from plantar.files import refuse_file, write_text
from plantar.logs.freed_memory import keep_freed
from plantar.logs.inputs import open_in_turn, read_ahead, robot_of

MODEL_HELP = (
    f"Model of the bush: {', '.join(MODEL_CHOICES)}. "
    f"{AUTOMATIC} takes the one that predicts held-out motions best."
)
OFFSET_HELP = "One offset per motion, or shared by all as in the paper."
CUTOFF_HELP = (
    f"Cut-off of the zero-phase low-pass filter on angles and torques, in Hz. If left out: {DEFAULT_CUTOFF:g}, or less "
    "where angle and torque of a walk are not coherent up to there."
)
WINDOW_HELP = "Use only deflections up to this many degrees from the resting pose."


def run(
    robot: identification.Robot,
    logs: identification.Logs,
    out: identification.Out,
    validate: identification.Validate = None,
    offset: Annotated[OffsetRule, typer.Option(help=OFFSET_HELP)] = "per-motion",
    model: Annotated[str, typer.Option(help=MODEL_HELP, metavar="MODEL")] = AUTOMATIC,
    wrench_delay: WrenchDelay = None,
    cutoff: Annotated[float | None, typer.Option(help=CUTOFF_HELP, metavar="HZ", min=0.1)] = None,
    window: Annotated[float | None, typer.Option(help=WINDOW_HELP, metavar="DEG", min=0.01)] = None,
    memory: Memory = None,
    json: identification.Json = False,
    quiet: identification.Quiet = False,
) -> None:
    """Stiffness, damping and offset of each foot, in pitch and roll, from logs of a standing or walking robot.

    Example: plantar identify feet talos.yaml sway_*.csv --validate squat.csv --out out/feet
    """
    if model not in MODEL_CHOICES:
        raise typer.BadParameter(f"'{model}' is not one of {', '.join(MODEL_CHOICES)}", param_hint="--model")
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
