"""Gaps: stretches of a log that hold nothing, in its rows or in single sensors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from plantar.conventions import Mask
from plantar.errors import clock
from plantar.logs.motion_log import MotionLog, device_of, imu_columns, wrench_columns
from plantar.notes import Finding
from plantar.robot.model import RobotModel
from plantar.signals.dropouts import dropouts_of
from plantar.signals.resampling import BRIDGED, sampling
from plantar.signals.segments import runs

JOINTS = "columns 'joint.*.position'"
LEAST_LOST = 0.03  # share of a log's time: less costs an interval nothing that anyone would notice


def check_gaps(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding on the time that is lost to gaps, where it is worth knowing: filters and delays need whole pieces.

    One more for each sensor that drops out, if a foot's fit needs it.
    """
    needed = {name for names in _sensors(robot).values() for name in names}
    for columns, mask in dropouts_of(log).items():
        if not needed.isdisjoint(columns):
            first = int(np.flatnonzero(mask)[0])
            single = len(columns) == 1
            where = f"column '{columns[0]}'" if single else f"columns '{device_of(columns[0])}.*'"
            text = (
                f"{where}, t = {clock(log.time[first])} s, value 0: {'reads' if single else 'read'} exactly 0 between "
                f"jumps in {len(runs(mask))} stretches, {100 * np.mean(mask):.2g} % of the log, left out; does the "
                "sensor lose its connection? (valid: leave such cells empty)"
            )
            yield Finding("dropout", text)
    gaps = [(start, end, "rows") for start, end in sampling(log).gaps]
    for what, names in _sensors(robot).items():
        present = [name for name in names if name in log.columns]
        known = [np.isfinite(log.column(name)) for name in present]
        if known and all(column.any() for column in known):
            gaps += [(start, end, what) for start, end in _holes(log, ~np.all(known, axis=0))]
    lost = sum(end - start for start, end, _ in gaps)
    lasts = log.duration - sum(end - start for start, end in log.left_out)
    if lost > LEAST_LOST * lasts:
        start, end, _ = max(gaps, key=lambda gap: gap[1] - gap[0])
        what = " and ".join(sorted({what for _, _, what in gaps}))
        text = f"{what}: {len(gaps)} gap{'s' * (len(gaps) > 1)}, the longest from t = {clock(start)} to {clock(end)} s"
        told = f"{text}, {100 * lost / lasts:.0f} % of the log: left out, and the delay is less well known"
        yield Finding("gaps", f"{told} (valid: every sensor at every time)")


def _holes(log: MotionLog, empty: Mask) -> list[tuple[float, float]]:
    """Start and end [s] of runs of empty cells that are not bridged; a sensor may start late and end early."""
    inner = [run for run in runs(empty) if run.start > 0 and run.stop < len(empty)]
    begins = {begin for begin, _ in log.left_out}
    inner = [
        run for run in inner if begins.isdisjoint(log.time[run].tolist())
    ]  # emptied where others are left out
    spans = [(float(log.time[run.start]), float(log.time[run.stop - 1])) for run in inner]
    return [(start, end) for start, end in spans if end - start > BRIDGED]


def _sensors(robot: RobotModel) -> dict[str, Sequence[str]]:
    """The columns that a foot's fit needs, by what they are called together."""
    found: dict[str, Sequence[str]] = {
        f"columns 'wrench.{foot.wrench.name}.*'": wrench_columns(foot.wrench.name)
        for foot in robot.feet.values()
    }
    if robot.imu is not None:
        found[f"columns 'imu.{robot.imu.name}.*'"] = imu_columns(robot.imu.name, "angular_velocity")
        found[JOINTS] = [f"joint.{name}.position" for name in sorted(robot.path_joints)]
    return found
