"""Plain YAML: every number with its unit, for people and for what has no target here."""

from __future__ import annotations

import yaml

from plantar.exporters.job import Job
from plantar.notes import Notes

HYSTERESIS = True  # every number is kept
KEPT = ("value", "unit", "std", "interval95", "verdict")
# The model of all with a slip that other targets hold; iwan and bouc_wen bend into the same two numbers.
ELASTOPLASTIC = (
    "an elastoplastic slip: slip_torque x e / slip_angle, e follows the deflection within +-slip_angle;"
)


def write(job: Job, notes: Notes) -> str:
    """The feet as YAML: geometry in the ankle's frame, and per axis the identified numbers."""
    rows = [row for row in job.result["parameters"] if row.get("name") is not None]
    feet = {}
    for foot in job.feet:
        axes: dict[str, dict[str, object]] = {}
        for row in rows:
            if row.get("foot") == foot.name:
                entry = {key: row[key] for key in KEPT if row.get(key) is not None}
                axes.setdefault(str(row["axis"]), {})[str(row["name"])] = entry
        for row in job.result.get("offsets", ()):
            if row.get("foot") == foot.name:
                offsets = axes.setdefault(str(row["axis"]), {}).setdefault("offset_by_motion", {})
                offsets[str(row.get("motion"))] = {"value": row["value"], "unit": row.get("unit")}  # type: ignore[index]
        feet[foot.name] = {
            "ankle": foot.ankle,
            "bush_centre": [float(value) for value in foot.centre],
            "bush_rotation": [[float(value) for value in row] for row in foot.rotation],
            "axes": axes,
        }
    lines = job.head("any reader", notes, joints=False)
    own = sorted({str(row["name"]) for row in rows} - {"stiffness", "damping"})
    beside = f" + what the bush model makes of {', '.join(own)}" if own else ""
    lines.append(f"torque = stiffness x deflection + damping x rate{beside} + offset;")
    if "slip_torque" in own:
        lines.append(ELASTOPLASTIC)
    lines.append("R_ankle_sole = Ry(pitch) Rx(roll);")
    lines.append(
        "force.z = stiffness x z + damping x rate, z positive when compressed. Lengths in m, ankle's frame."
    )
    document = {"robot": job.result.get("robot"), "plantar": job.result.get("plantar"), "feet": feet}
    return "".join(f"# {line}\n" for line in lines) + yaml.safe_dump(document, sort_keys=False)
