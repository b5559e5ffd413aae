"""`plantar identify inertia`."""

from __future__ import annotations

from plantar.cli import identify_dynamics as common
from plantar.cli.dynamics_tables import print_inertia
from plantar.cli.terminal import progress
from plantar.identify.inertia import identify_inertia
from plantar.identify.whole_body import DynamicsSettings


def run(
    robot: common.Robot,
    logs: common.Logs,
    out: common.Out,
    validate: common.Validate = None,
    cutoff: common.Cutoff = common.CUTOFF,
    as_recorded: common.AsRecorded = False,
    json: common.Json = False,
    quiet: common.Quiet = False,
) -> None:
    """Masses, centres and inertias of a floating-base robot's links from IMU, encoders and feet (eq. 2).

    Example: plantar identify inertia talos.yaml walk_1.csv --validate walk_2.csv --out out/inertia
    """
    settings = DynamicsSettings(cutoff, as_recorded)
    common.identified(
        lambda known, fitted, unseen: identify_inertia(known, fitted, unseen, settings, progress(quiet)),
        print_inertia,
        robot,
        logs,
        validate,
        out,
        json=json,
        quiet=quiet,
    )
