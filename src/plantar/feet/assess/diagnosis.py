"""What limits each number, and what recording would make it tighter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.systematic import Cause
from plantar.results.feet import Parameter

REMEDY = {
    "noise": "record the same motion for longer: four times as long halves it",
    "delay": "add a recording of arm sweeps at 0.3 to 1 Hz without an operator: it shows the wrenches' delay",
    "lever": "add a slow shift of the weight from foot to foot: it shows the vertical compliance",
    "force gain": "weigh the robot: then calibrate the force sensors, or correct the URDF's masses",
    "yaw torque zero": "zero the force sensors with the feet in the air before recording",
    "between walks": "add walks: five or more show by themselves how much they differ",
    "ends of stances": "walk with longer stances, or stand and sway: landing and lifting disturb the fit",
    "memory in stances": "add a recording of standing and swaying: short steps hardly tell spring and memory apart",
    "hardening": "record larger motions, or ask for --model hardening: the spring stiffens, and the law leaves it out",
    "model": "more of the same will not help: the law misses what the rubber does; try --model auto or other motions",
    "excitation": "move further: twice the amplitude halves it",
}
MODEL_SHARE = 10.0  # times the white deviation: residuals this coloured are the law's, not noise


def diagnose_axis(
    fit: AxisFit, wide: AxisFit, causes: Sequence[Cause], rows: Sequence[Parameter]
) -> list[dict[str, Any]]:
    """For each parameter the share of each cause in its variance, the largest one, and what it would be without it."""
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
        shares[name] = float(fit.std[place] / total) ** 2
        limit = max(shares, key=lambda cause: shares[cause])
        without = float(np.sqrt(max(0.0, 1 - shares[limit])))
        percent = 196 * total / abs(row.value)
        term = row.name.replace("_", " ")
        text = (
            f"{row.foot} {row.axis} {term}: ±{percent:.2g} %, {100 * shares[limit]:.0f} % of its variance from "
            f"{limit}; without it ±{percent * without:.2g} %. To tighten: {REMEDY[limit]}"
        )
        found.append({"foot": row.foot, "axis": row.axis, "name": row.name, "limit": limit, "variance_shares": shares,
                      "half_width_percent": percent, "text": text})  # fmt: skip
    return found


def advised(rows: Sequence[Parameter], diagnosis: Sequence[Mapping[str, Any]]) -> list[Parameter]:
    """The rows with the advice that fits what limits them: more of the same motion does not help against a delay."""
    limits = {(each["foot"], each["axis"], each["name"]): each["limit"] for each in diagnosis}
    found = []
    for row in rows:
        limit = limits.get((row.foot, row.axis, row.name))
        if row.verdict != "usable" and limit in (
            "delay",
            "lever",
            "hardening",
            "yaw torque zero",
            "force gain",
        ):
            row = replace(row, reason=f"{row.reason}; nearly all of it from {limit}", advice=REMEDY[limit])
        found.append(row)
    return found
