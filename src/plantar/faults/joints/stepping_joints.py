"""Encoders that stand still while their leg steps: the closed chain of both legs hardly sees them in a walk."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.errors import clock
from plantar.faults.channels import TURNED
from plantar.faults.joints.names import legs
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel
from plantar.signals.footfalls import footfalls
from plantar.signals.segments import runs

FEWEST = 2  # times that the foot lands or leaves: a whole step or stance of it
WHOLE = 0.5  # of a usual swing or stance: a foot that bounces as it lands makes no step


def check_stepping_joints(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding for each leg joint that keeps one value through a step in which another leg's same joint turns.

    A joint that no leg uses stands still in all of them.
    """
    every = legs(robot)
    for foot, own in every.items():
        changes = footfalls(log, robot.feet[foot].wrench.name)
        if len(changes) < FEWEST:
            continue
        others = [leg for name, leg in every.items() if name != foot and len(leg) == len(own)]
        for place, joint in enumerate(own):
            position = log.joint(joint, "position")
            run = None if position is None or not others else _longest_step(position, changes)
            if position is None or run is None:
                continue
            turned = {leg[place]: _range(log.joint(leg[place], "position"), run) for leg in others}
            same = max(turned, key=turned.__getitem__)
            if turned[same] > TURNED:
                when = f"t = {clock(log.time[run.start])} to {clock(log.time[run.stop - 1])} s"
                text = (
                    f"column 'joint.{joint}.position', {when}, value {position[run.start]:.6g}: stands still while its "
                    f"leg steps and '{same}' turns {turned[same]:.2g} rad; is the encoder dead? (valid: leave such "
                    "cells empty)"
                )
                yield Finding("stuck_channel", text)


def _longest_step(position: Array, changes: NDArray[np.intp]) -> slice | None:
    """The longest run of samples at one position in which the foot lands or leaves often enough for a step."""
    still = [slice(run.start, run.stop + 1) for run in runs(np.diff(position) == 0)]
    ends = np.searchsorted(changes, [(run.start, run.stop) for run in still]).reshape(-1, 2)
    spans = np.sort(np.diff(changes))
    until = np.cumsum(spans)
    shortest = WHOLE * spans[np.searchsorted(until, until[-1] / 2)]  # half of the time is in longer ones
    steps = [
        run
        for run, (begun, over) in zip(still, ends, strict=True)
        if over - begun >= FEWEST and run.stop - run.start > shortest
    ]
    return max(steps, key=lambda run: run.stop - run.start, default=None)


def _range(position: Array | None, run: slice) -> float:
    known = position is not None and np.isfinite(position[run]).any()
    return (
        float(np.nanmax(position[run]) - np.nanmin(position[run])) if known and position is not None else 0.0
    )
