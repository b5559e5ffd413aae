"""What a design leaves on disk: the motion for any controller, and what it promises."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from plantar.choices import number_in
from plantar.conventions import ROTATIONAL_AXES
from plantar.design.rehearsal import Rehearsal
from plantar.design.story import EFFORT, FRICTION, KEPT, Design
from plantar.files import write_text
from plantar.logs.save import save_log
from plantar.models import KelvinVoigt
from plantar.results.io import dump_json

SCHEMA = "plantar.design/1"
SLOWEST, FASTEST = 20.0, 2000.0  # Hz


def write_design(found: Design, path: Path, rate: float) -> None:
    """Write the motion as CSV and, beside it, the JSON. Raises SettingsError for a rate that no controller has."""
    number_in("rate", rate, SLOWEST, FASTEST, "Hz")
    save_log(found.trajectory.log(rate), path)
    write_text(path.with_suffix(".json"), dump_json(content_of(found, path, rate)))


def content_of(found: Design, path: Path, rate: float) -> dict[str, Any]:
    """MOTION.json: `plantar.design/1`."""
    model, told = KelvinVoigt(), found.told
    values = {"stiffness": told.stiffness, "damping": told.damping}
    parameters = [
        {
            "foot": foot, "axis": axis, "name": name, "unit": model.unit(name, axis), "value": values[name],
            "half_width_percent": found.nominal.percent(foot, axis, name),
            "at": [
                {"factor": one.factor, "half_width_percent": one.percent(foot, axis, name)}
                for one in found.rehearsals
            ],
        }
        for foot in found.robot.feet
        for axis in ROTATIONAL_AXES
        for name in model.terms
    ]  # fmt: skip
    way, speed = found.limits_used
    return {
        "schema": SCHEMA,
        "robot": found.robot.name,
        "motion": path.name,
        "settings": asdict(found.settings) | {"rate": rate},
        "stiffness_range": [factor * told.stiffness for factor in found.factors],
        "least_stiffness": found.least_stiffness,
        "parameters": parameters,
        "rehearsals": [_rehearsal(one) for one in found.rehearsals],
        "limits": [
            {"limit": "distance of each foot's centre of pressure from its sole's border", "unit": "m",
             "kept": KEPT, "reached": min(one.sole_margin for one in found.rehearsals)},
            {"limit": "friction, horizontal to vertical force of a foot", "unit": "", "kept": FRICTION,
             "reached": max(one.friction for one in found.rehearsals)},
            {"limit": "joint torque, share of its limit", "unit": "", "kept": EFFORT,
             "reached": max(one.effort for one in found.rehearsals)},
            {"limit": "joint position, share of the way from standing to its limit", "unit": "",
             "kept": 1.0, "reached": way},
            {"limit": "joint speed, share of its limit", "unit": "", "kept": 1.0, "reached": speed},
        ],
    }  # fmt: skip


def _rehearsal(one: Rehearsal) -> dict[str, Any]:
    return {
        "factor": one.factor, "sole_margin": one.sole_margin, "least_load": one.least_load, "friction": one.friction,
        "effort": one.effort, "bend": one.bend,
    }  # fmt: skip
