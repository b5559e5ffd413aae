"""Ranges for training: means, standard deviations and correlations of what was identified, as YAML.

An error of a force sensor's gain moves every number of its foot by the same share, an error of the sensors' delay moves
every damping, a turned IMU every offset: such causes are shared, all others are each number's own. With a_ik the part
of number i's standard deviation that comes from shared cause k, i and j correlate by Σ_k a_ik a_jk / (s_i s_j).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import yaml

from plantar.conventions import NORMAL95, STIFFNESS_UNIT, Array
from plantar.exporters.bush import FootBush
from plantar.exporters.job import Job
from plantar.exporters.source import robot_model
from plantar.notes import Notes
from plantar.robot.uncertainty import Uncertainty

HYSTERESIS = True  # for models of `mjcf`, which hold it
SCHEMA: Final = "plantar.randomization/1"
GAINS: Final = ("sensor gain", "force gain", "torque gain")  # causes that scale all numbers of one foot
SUM_ONLY: Final = "z_sum_only"  # the note of a result whose vertical stiffness is one number for all feet
LEG_JOINTS: Final = 6  # between IMU and foot: each encoder's zero turns the foot by at most itself
DELAY: Final = "delay"  # late sensors take K times what they are late off the damping
CAREFUL: Final = Uncertainty()  # of a result that does not say what its robot file may be off by
# Standing feet do not show where they slip. From damp or dusty to dry floors, for rubber soles; not measured.
FRICTION: Final = (0.4, 1.0)


@dataclass(frozen=True)
class Number:
    """One random number: jointly normal, `shared` its part of each shared cause as a share of `std`, below 1 in sum of
    squares."""

    name: str
    unit: str
    mean: float
    std: float
    positive: bool
    shared: Mapping[str, float] = field(default_factory=dict)


def write(job: Job, notes: Notes) -> str:
    """The YAML's text. What has no standard deviation stands with 0 and a note."""
    numbers = [number for foot in job.feet for number in _of_foot(job.result, foot, notes)]
    numbers += [*_delay(job.result), *_zeros(job.result, job.feet)]
    rows = [
        {"name": one.name, "unit": one.unit, "distribution": "normal", "mean": one.mean, "std": one.std}
        | ({"above": 0.0} if one.positive else {})
        for one in numbers
    ]
    text = f"friction was not measured: {FRICTION[0]:g} to {FRICTION[1]:g} is what rubber has on floors"
    notes.warning("export_friction", text)
    document = {
        "schema": SCHEMA,
        "robot": job.result.get("robot"),
        "plantar": job.result.get("plantar"),
        "parameters": rows,
        "correlation": [[round(float(value), 4) for value in row] for row in correlation(numbers)],
        "independent": [
            {"name": "friction", "unit": "1", "distribution": "uniform", "low": FRICTION[0], "high": FRICTION[1],
             "measured": False},
        ],
    }  # fmt: skip
    lines = job.head("training", notes, joints=False)
    lines.append("parameters are jointly normal: mean, std and, in their order, correlation.")
    body = yaml.safe_dump(document, sort_keys=False, default_flow_style=None, width=120)
    return "".join(f"# {line}\n" for line in lines) + body


def correlation(numbers: Iterable[Number]) -> Array:
    """The correlation matrix (n, n) of numbers with shared causes: ones on its diagonal, positive semidefinite."""
    numbers = list(numbers)
    causes = list(dict.fromkeys(cause for one in numbers for cause in one.shared))
    parts = np.array([[one.shared.get(cause, 0.0) for cause in causes] for one in numbers])
    matrix = parts.reshape(len(numbers), len(causes)) @ parts.reshape(len(numbers), len(causes)).T
    np.fill_diagonal(matrix, 1.0)
    return np.asarray(matrix)


def _of_foot(result: Mapping[str, Any], foot: FootBush, notes: Notes) -> list[Number]:
    """Stiffness, damping and slip of each axis as `mjcf` writes them, with the identified relative deviation."""
    numbers = []
    for spring in foot.springs:
        k, c, _ = spring.units
        values = [("stiffness", spring.stiffness, k), ("damping", spring.damping, c)]
        if spring.slip is not None:
            values += [("slip_torque", spring.slip.torque, "N.m"), ("slip_angle", spring.slip.angle, "rad")]
            text = (
                f"{foot.name}.{spring.axis}: K and C are those beside a slip, as in the model of --to mjcf; "
            )
            text += "a model without it wants the K and C that its own target writes"
            notes.info("export_slip", text)
        for name, mean, unit in values:
            key = {"foot": foot.name, "axis": spring.axis, "name": name}
            row = _row(result.get("parameters", ()), key)
            where = f"{foot.name}.{spring.axis}.{name}"
            relative = _relative(row)
            if name == "damping" and spring.assumed and relative is not None:
                # Unlike one number, a range holds what is not known: its width says so.
                mean = float(row["value"])
                text = f"{where}: unidentifiable; the range is as wide as the logs leave it, cut at 0"
                notes.warning("export_wide", text)
            if relative is None:
                text = f"{where}: no standard deviation is known, so it is written as 0"
                notes.warning("export_spread", text)
            shared = _shared(_row(result.get("diagnosis", ()), key), foot.name, name)
            if spring.axis == "z" and name == "stiffness" and _z_is_one(result):
                shared = {"vertical stiffness": 1.0}
            numbers.append(Number(where, unit, mean, (relative or 0.0) * abs(mean), True, shared))
    return numbers


def _row(rows: Iterable[Mapping[str, Any]], key: Mapping[str, str]) -> Mapping[str, Any]:
    return next((row for row in rows if all(row.get(name) == value for name, value in key.items())), {})


def _relative(row: Mapping[str, Any]) -> float | None:
    """Standard deviation over value: of the row, or of its interval as if it were normal."""
    value, std, interval = row.get("value"), row.get("std"), row.get("interval95")
    if not value:
        return None
    if std is None and interval is not None:
        std = (interval[1] - interval[0]) / (2 * NORMAL95)
    return None if std is None else abs(float(std) / float(value))


def _shared(row: Mapping[str, Any], foot: str, name: str) -> dict[str, float]:
    shares = row.get("variance_shares") or {}
    shared = {f"{foot} {cause}": float(np.sqrt(shares[cause])) for cause in GAINS if shares.get(cause)}
    if name == "damping" and shares.get(DELAY):
        shared[DELAY] = float(np.sqrt(shares[DELAY]))
    return shared


def _z_is_one(result: Mapping[str, Any]) -> bool:
    """Whether the logs showed only the sum over the feet, so that each got the same number with the same error."""
    return any(isinstance(note, Mapping) and note.get("code") == SUM_ONLY for note in result.get("notes", ()))


def _delay(result: Mapping[str, Any]) -> list[Number]:
    found = result.get("latency") or {}
    mean, std = found.get("wrench_delay"), found.get("std")
    if mean is None or std is None:
        return []
    return [Number("wrench.delay", "s", float(mean), float(std), False, {DELAY: 1.0})]


def _zeros(result: Mapping[str, Any], feet: Iterable[FootBush]) -> list[Number]:
    """Offsets: their scatter from recording to recording, and what no recording shows, since it is the same in all.

    A turned IMU and encoders whose zero is off lean every deflection by the same angle, and every offset by K times it.
    """
    known = robot_model(result).get("uncertainty") or {}
    mount, encoder = (float(known.get(key, getattr(CAREFUL, key))) for key in ("imu_mount", "encoder_zero"))
    numbers = []
    for foot in feet:
        for spring in foot.springs:
            values = [
                (float(row["value"]), float(row.get("std") or 0.0))
                for row in result.get("offsets", ())
                if row.get("foot") == foot.name and row.get("axis") == spring.axis
            ]
            if not values:
                continue
            found, own = np.array(values).T
            scatter = float(found.std(ddof=1)) if len(found) > 1 else 0.0
            unit = STIFFNESS_UNIT[spring.axis].split("/")[0]
            name = f"{foot.name}.{spring.axis}.offset"
            if spring.axis == "z":
                numbers.append(Number(name, unit, float(found.mean()), scatter or float(own[0]), False))
                continue
            turned = spring.stiffness * mount
            unshown = float(np.hypot(turned, spring.stiffness * encoder * np.sqrt(LEG_JOINTS)))
            # An offset's own holds the mount as well.
            std = max(float(np.hypot(scatter, unshown)), float(own.min()))
            shared = {f"imu {spring.axis}": turned / std} if std > 0 else {}
            numbers.append(Number(name, unit, float(found.mean()), std, False, shared))
    return numbers
