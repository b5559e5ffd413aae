"""What the robot file says may be wrong: what the logs show of it, and what is left of it in the intervals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import NamedTuple

import numpy as np

from plantar.conventions import NORMAL95
from plantar.feet.foot_assessment import FootFit
from plantar.feet.interval_width.between_recordings import Apart
from plantar.feet.prepare import PreparedLogs
from plantar.feet.regression.axis import AxisFit
from plantar.results.feet_rows import Assumption, Diagnosis

# Causes in the variance of stiffness and damping, by the key of `uncertainty` that they come from.
CAUSES: Mapping[str, tuple[str, ...]] = {
    "wrench_gain": ("sensor gain", "force gain", "torque gain"),
    "wrench_delay": ("delay",),
    "bush_position": ("bush position",),
    "joint_compliance": ("joint compliance",),
    "imu_mount": ("imu turn",),
    "between_recordings": ("between recordings", "between walks"),
}


class Found(NamedTuple):
    """One number that logs show: `what` it is of ("" where there is one only), `value` and its deviation, if known."""

    what: str
    value: float | None
    std: float | None


def assumptions(ready: PreparedLogs, feet: Sequence[FootFit], apart: Apart) -> tuple[Assumption, ...]:
    """A row for each key of `uncertainty` and each number that the logs show of it. apart: what all axes show
    recordings to differ by."""
    fits = [fit for foot in feet for fit in foot.fits]
    limits = [row for foot in feet for row in foot.diagnosis]
    found: dict[str, list[Found]] = {
        "wrench_gain": [
            Found(f"{foot}, beside the weight", gain.share, float(np.hypot(gain.std, gain.other)))
            for foot, gain in ready.gain_errors.items()
        ],
        "wrench_delay": _delays(ready) if ready.sensor_delay.measured else [],
        "bush_position": [place for foot in ready.robot.feet for place in _places(foot, fits)],
        "joint_compliance": _bending(ready),
        "imu_mount": _turns(ready, fits),
        "between_recordings": []
        if apart.shown is None
        else [Found("", apart.share, float(np.ptp(apart.shown)) / (2 * NORMAL95))],
    }
    rows = []
    for name, assumed in asdict(ready.robot.uncertainty).items():
        widths = [_width(limits, number, CAUSES.get(name, ())) for number in ("stiffness", "damping")]
        for what, value, std in found.get(name) or [Found("", None, None)]:
            rows.append(Assumption(name, what, assumed, value, std, *widths))
            widths = [None, None]
    return tuple(row for row in rows if row.name != "total_mass" or ready.robot.weighed is not None)


def _delays(ready: PreparedLogs) -> list[Found]:
    """Of each foot's force sensor where they differ, else of all."""
    delay = ready.sensor_delay
    return [Found(foot, value, delay.std) for foot, value in delay.feet.items()] or [
        Found("", delay.delay, delay.std)
    ]


def _bending(ready: PreparedLogs) -> list[Found]:
    """Of all joints that carry the robot together, where the moments of its motion are known."""
    shown = ready.bending
    return [] if shown.mean is None else [Found("joints of legs and trunk together", shown.mean, shown.std)]


def _places(foot: str, fits: Iterable[AxisFit]) -> list[Found]:
    """Where the bush's centre is beside its place [m]: pitch shows x, roll y, both of them z."""
    own = {fit.axis: fit for fit in fits if fit.foot == foot}
    found = []
    for axis, name, sign in (("pitch", "x", -1.0), ("roll", "y", 1.0)):
        if axis in own:
            found.append(Found(f"{foot} {name}", sign * own[axis].moment_arms[0], own[axis].place_std[0]))
    return [*found, *_together(f"{foot} z", [(fit.moment_arms[1], fit.place_std[1]) for fit in own.values()])]


def _turns(ready: PreparedLogs, fits: Sequence[AxisFit]) -> list[Found]:
    """By how much the IMU is turned about its axes [rad], as steps show it, else as all axes do: the other way than the
    turn that puts its angles right."""
    turn = ready.imu_turn
    if any(turn.angles):
        known = zip(turn.angles, np.sqrt(np.diag(turn.covariance)).tolist(), strict=True)
        return [Found(axis, -angle, std) for axis, (angle, std) in zip("xyz", known, strict=True)]
    shown = [
        _together(axis, [(-fit.imu_turned[about], fit.place_std[3 + about]) for fit in fits])
        for about, axis in enumerate("xyz")
    ]
    return [one for own in shown for one in own if one.std is not None]


def _together(what: str, told: Sequence[tuple[float, float | None]]) -> list[Found]:
    """One value of what several axes tell, as sure as the surest of them where they agree; none where none does.

    They share the prior, and a robot's other errors: four of them are no surer than one.
    """
    sure = [(value, std) for value, std in told if std]
    if not sure:
        return [Found(what, float(np.mean([value for value, _ in told])), None)] if told else []
    values, deviations = np.array(sure).T
    mean = float(np.average(values, weights=deviations**-2))
    apart = float(np.sqrt(np.sum(((values - mean) / deviations) ** 2) / max(len(values) - 1, 1)))
    return [Found(what, mean, float(deviations.min()) * max(1.0, apart))]


def _width(limits: Sequence[Diagnosis], number: str, causes: Sequence[str]) -> float | None:
    """Half of the 95 % interval that these causes alone would make, of the axis where it is largest [%]."""
    if not causes:
        return None
    shares = [
        row.half_width_percent * sum(row.variance_shares.get(cause, 0.0) for cause in causes) ** 0.5
        for row in limits
        if row.name == number
    ]
    return max(shares, default=None)
