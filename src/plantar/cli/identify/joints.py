"""`plantar identify joints`."""

from __future__ import annotations

from typing import Annotated

from typer import Option

from plantar.cli.console import options
from plantar.cli.console.terminal import progress
from plantar.cli.identify import identification
from plantar.cli.identify.dynamics_tables import print_joints
from plantar.report import write_dynamics_report
from plantar.results.dynamics import URDF
from plantar.whole_body.joints import Inertia, identify_joints
from plantar.whole_body.settings import DynamicsSettings

HELP = "Inertias: fitted together with the joints, first (eq. 2; floating bases), or known (the URDF's)."


def run(
    robot: options.Robot,
    logs: options.Logs,
    out: options.Out,
    validate: options.Validate = None,
    inertia: Annotated[Inertia, Option("--inertia", help=HELP)] = "together",
    cutoff: options.Cutoff = DynamicsSettings.cutoff,
    as_recorded: options.AsRecorded = False,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Friction, springs, offsets and actuator inertia of the joints from their torques (eq. 3).

    Example: plantar identify joints arm.yaml sweep_1.csv --validate sweep_2.csv --out out/joints
    """
    known, fitted, unseen = identification.opened(robot, logs, validate, out, memory)
    settings = DynamicsSettings(cutoff, as_recorded)
    result = identify_joints(known, fitted, unseen, settings, progress(quiet), inertia=inertia)
    identification.keep(
        result, out, write_dynamics_report, print_joints, json=json, quiet=quiet, beside=[URDF]
    )
