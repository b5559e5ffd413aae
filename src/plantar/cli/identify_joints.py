"""`plantar identify joints`."""

from __future__ import annotations

from typing import Annotated

import typer

from plantar.cli import identify_dynamics as common
from plantar.cli.dynamics_tables import print_joints
from plantar.cli.terminal import progress
from plantar.identify.joints import Inertia, identify_joints
from plantar.identify.whole_body import DynamicsSettings

HELP = "Inertias: fitted together with the joints, first (eq. 2; floating bases), or known (the URDF's)."


def run(
    robot: common.Robot,
    logs: common.Logs,
    out: common.Out,
    validate: common.Validate = None,
    inertia: Annotated[Inertia, typer.Option("--inertia", help=HELP)] = "together",
    cutoff: common.Cutoff = common.CUTOFF,
    as_recorded: common.AsRecorded = False,
    json: common.Json = False,
    quiet: common.Quiet = False,
) -> None:
    """Friction, springs, offsets and actuator inertia of the joints from their torques (eq. 3).

    Example: plantar identify joints arm.yaml sweep_1.csv --validate sweep_2.csv --out out/joints
    """
    settings = DynamicsSettings(cutoff, as_recorded)
    common.identified(
        lambda known, fitted, unseen: identify_joints(
            known, fitted, unseen, settings, progress(quiet), inertia=inertia
        ),
        print_joints,
        robot,
        logs,
        validate,
        out,
        json=json,
        quiet=quiet,
    )
