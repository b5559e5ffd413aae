"""What limits each number, and what recording would make it tighter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import NORMAL95
from plantar.feet.assess.data_faults import ADVICE, first_sentence
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.axis import AxisFit
from plantar.notes import Note
from plantar.results.feet import Diagnosis, Parameter
from plantar.results.numbers import number
from plantar.sensors.delays.sensor_delay import UNKNOWN

ZEROS_OF_STANCES = "zeros of stances"
REMEDY = {
    "noise": "record the same motion for longer: four times as long halves the interval",
    "delay": "add a recording of arm sweeps at 0.3 to 1 Hz without an operator: it shows the force sensors' delay",
    "moment arm": "add a slow shift of the weight from foot to foot: it shows the vertical compliance",
    "sensor gain": "calibrate the force sensors, and say so in the robot file: uncertainty: wrench_gain",
    "between recordings": "recordings differ by more than each alone shows: warm the rubber up, check the joints "
    "between IMU and foot, record more of them",
    "force gain": "weigh the robot and write its mass into the robot file (mass: ...). If the URDF was wrong, that "
    "narrows the interval and hardly moves the number; if it was right, calibrate the force sensors, which the number "
    "follows",
    "torque gain": "check unit and calibration of the torque channels, and correct the logs",
    "encoders' delay": "add a recording of arm sweeps at 0.3 to 1 Hz without an operator: it shows the encoders' time "
    "beside the IMU's; or read both at once",
    "joint compliance": "use encoders on the output side of the gears, or measure how far joints bend under load and "
    "write what stays unknown into the robot file (uncertainty: joint_compliance)",
    "low-pass": "filter all sensors alike, or with a cut-off far above the motion's frequencies",
    "yaw torque zero": "before the next recording, zero the force sensors with the feet in the air",
    "between walks": "add walks: the mean of more is surer, and five or more show by themselves how much they differ",
    "ends of stances": "walk with longer stances, or stand and sway: landing and lifting disturb the fit",
    "angle errors": "use larger motions, beside which errors of the angle are small; or an attitude that wanders less, "
    "and encoders without noise or play",
    ZEROS_OF_STANCES: "keep the foot on the floor through a recording: put down again, it lands with another zero",
    "bush position": "measure where the bush's centre is beside the force sensor, and write it into the robot file "
    "(bush: xyz, and uncertainty: bush_position); or record larger motions, which show it",
    "imu turn": "add walks along curves: they show how the IMU is turned in its mount; or measure it and write it into "
    "the robot file (imu: rpy, and uncertainty: imu_mount)",
    "memory in stances": "add a recording of standing and swaying: short steps hardly separate spring and hysteresis",
    "slip angle": "record other motions of the same size: these do not show more exactly at which angle the "
    "rubber begins to slip",
    "hidden memory": "record larger motions, standing and swaying: spring and hysteresis look the same until the "
    "rubber slips",
    "hardening": "record larger motions, or use --model hardening: the stiffness changes with the angle",
    "softening": "load the force sensors with known torques, small and large: rubber hardens, and what seems to soften "
    "may be a sensor that bends",
    "model": "more logs like these will not help: the model does not fit the rubber; try --model auto or other motions",
    "excitation": "use larger motions: twice the amplitude halves the interval",
}
# Causes that no more of the same motion makes smaller: the advice against them replaces the axis' own.
OTHER_MOTION_HELPS = (
    "delay", "encoders' delay", "moment arm", "hardening", "softening", "yaw torque zero", ZEROS_OF_STANCES,
    "force gain", "torque gain", "imu turn", "low-pass", "joint compliance", "between recordings", "angle errors",
)  # fmt: skip
GAINS = ("force_gain", "torque_gain")  # codes of warnings on a sensor's gain
NEARLY_ALL = 0.9  # of the variance
MODEL_SHARE = 10.0  # times the white deviation: residuals this coloured are the model's, not noise


def diagnose_axis(
    fit: AxisFit, wide: AxisFit, causes: Sequence[Cause], rows: Sequence[Parameter]
) -> list[Diagnosis]:
    """For each parameter: the share of each cause in its variance, the largest cause, and the interval without it."""
    found = []
    for place, row in enumerate(rows[: len(fit.values)]):
        total = float(wide.std[place])
        if not total > 0 or not row.value:
            continue
        shares = {cause.name: float(cause.share[place] / total) ** 2 for cause in causes}
        name = "noise"
        if row.verdict == "unidentifiable":
            name = "excitation"
        elif fit.std[place] > MODEL_SHARE * fit.white_std[place]:
            name = "model"
        for cause, variance in fit.place_variance.items():
            shares[cause] = float(variance[place]) / total**2
        own = float(fit.std[place]) ** 2 - sum(float(each[place]) for each in fit.place_variance.values())
        shares[name] = max(0.0, own) / total**2
        limit = max(shares, key=lambda cause: shares[cause])
        without = float(np.sqrt(max(0.0, 1 - shares[limit])))
        # As the row itself says it, which knows how few the data are that it comes from.
        percent = row.half_width_percent or 100 * NORMAL95 * total / abs(row.value)
        term = row.name.replace("_", " ")
        text = (
            f"{row.foot} {row.axis} {term}: ±{number(percent, 2)} %, {share_of(limit, shares)}; without it "
            f"±{number(percent * without, 2)} %. To tighten: {REMEDY[limit]}"
        )
        found.append(
            Diagnosis(row.foot, row.axis, row.name, limit, shares, percent, text, advice=REMEDY[limit])
        )
    return found


def share_of(limit: str, shares: Mapping[str, float]) -> str:
    """How much of the variance a cause makes, in words that fit the share."""
    share = shares[limit]
    if share > NEARLY_ALL:
        return f"nearly all of it from {limit}"
    return f"{100 * share:.0f} % of its variance from {limit}"


def untimed(rows: Sequence[Parameter], delay: Note) -> list[Parameter]:
    """The rows, damping no longer usable where the note of the `delay` says that no log shows it.

    Damping follows it one to one: force sensors 30 ms early made C 42 % too large, and its interval the smaller share.
    """
    why = "no log shows how late the force sensors are, and damping follows that"
    return [
        replace(row, verdict="weak", reason=f"{why}; {row.reason}", advice=REMEDY["delay"])
        if delay.code == UNKNOWN and (row.name, row.verdict) == ("damping", "usable")
        else row
        for row in rows
    ]


def mend_first(rows: Sequence[Parameter], faults: Sequence[Note]) -> list[Parameter]:
    """The rows, those that are not usable with no other advice than to mend the data's first fault.

    What else they lack, more motion or another model, may be nothing but that fault. A wrong gain is none of these: it
    scales a number and hides none, and stands among the causes with its share.
    """
    if all(note.code in GAINS for note in faults):
        return [
            replace(row, advice=REMEDY[faults[0].code.replace("_", " ")]) if row.advice == ADVICE else row
            for row in rows
        ]
    return [
        row
        if row.verdict == "usable" or row.advice == ADVICE
        else replace(row, advice=f"{ADVICE}: {first_sentence(faults[0])}")
        for row in rows
    ]


def advised(rows: Sequence[Parameter], diagnosis: Sequence[Diagnosis]) -> list[Parameter]:
    """The rows with the advice that fits what limits them: more of the same motion does not help against a delay."""
    limits = {(each.foot, each.axis, each.name): each for each in diagnosis}
    found = []
    for row in rows:
        each = limits.get((row.foot, row.axis, row.name))
        if row.verdict != "usable" and each and each.limit in OTHER_MOTION_HELPS:
            told = share_of(each.limit, each.variance_shares)
            row = replace(row, reason=f"{row.reason}; {told}", advice=each.advice)
        elif row.verdict == "unidentifiable" and each and ZEROS_OF_STANCES in each.variance_shares:
            anew = "the foot was lifted and put down again, each time with another zero"
            row = replace(row, reason=f"{row.reason}; {anew}", advice=REMEDY[ZEROS_OF_STANCES])
        found.append(row)
    return found
