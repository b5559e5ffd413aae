"""`plantar identify inertia`."""

from __future__ import annotations

from plantar.cli.console import options
from plantar.cli.console.terminal import progress
from plantar.cli.identify import identification
from plantar.cli.identify.dynamics_tables import print_inertia
from plantar.report import write_dynamics_report
from plantar.results.dynamics import URDF
from plantar.whole_body.inertia import identify_inertia
from plantar.whole_body.settings import DynamicsSettings


def run(
    robot: options.Robot,
    logs: options.Logs,
    out: options.Out,
    validate: options.Validate = None,
    cutoff: options.Cutoff = DynamicsSettings.cutoff,
    as_recorded: options.AsRecorded = False,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Masses, centres and inertias of a floating-base robot's links from IMU, encoders and feet (eq. 2).

    Example: plantar identify inertia talos.yaml walk_1.csv --validate walk_2.csv --out out/inertia
    """
    known, fitted, unseen = identification.opened(robot, logs, validate, out, memory)
    settings = DynamicsSettings(cutoff, as_recorded)
    result = identify_inertia(known, fitted, unseen, settings, progress(quiet))
    identification.keep(
        result, out, write_dynamics_report, print_inertia, json=json, quiet=quiet, beside=[URDF]
    )
