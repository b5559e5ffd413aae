"""What a design leaves on disk: the motion for any controller, and what it promises."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from plantar.choices import number_in, one_of
from plantar.conventions import ROTATIONAL_AXES
from plantar.design.information import WANTED, WANTED_DELAY, WANTED_VERTICAL
from plantar.design.reach import FRICTION
from plantar.design.rehearsals.attempt import EFFORT, KEPT
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.design.story import Design
from plantar.design.writing import promised
from plantar.design.writing.controllers import TARGETS, ordered_joints
from plantar.design.writing.foretold import foretold
from plantar.design.writing.sheet import sheet
from plantar.files import write_text
from plantar.logs.save import save_log
from plantar.models import KelvinVoigt
from plantar.results.io import dump_json
from plantar.robot.model import RobotModel

SCHEMA = "plantar.design/1"
SLOWEST, FASTEST = 20.0, 2000.0  # Hz: rates of controllers that play joint positions
APPROACH: Final = (0.25, 0.5)  # of the amplitude, to be played before the whole


def check_outputs(robot: RobotModel, rate: float, targets: Sequence[str]) -> None:
    """Raise SettingsError for a rate that no controller has, a target that is unknown, or joints in an order that
    cannot be."""
    number_in("rate", rate, SLOWEST, FASTEST, "Hz")
    for target in targets:
        one_of("--to", target, TARGETS)
    ordered_joints(robot)


def write_design(
    found: Design, path: Path, rate: float, targets: Sequence[str], approach: bool
) -> dict[str, Any]:
    """Write the motion as CSV, beside it the JSON, which is returned, and the sheet; and files for the controllers in
    `targets`, and gentler versions of all where `approach`.

    Raises SettingsError for a rate that no controller has, or a target that is unknown.
    """
    check_outputs(found.robot, rate, targets)
    content = content_of(found, path, rate)
    for share in (1.0, *(APPROACH if approach else ())):
        motion = path if share == 1.0 else path.with_stem(f"{path.stem}_{round(100 * share)}")
        trajectory = found.trajectory if share == 1.0 else found.gentler(share)
        save_log(trajectory.log(rate), motion)
        for target in targets:
            ending, write = TARGETS[target]
            write(trajectory, rate, motion.with_suffix(ending))
    write_text(path.with_suffix(".json"), dump_json(content))
    write_text(path.with_suffix(".md"), sheet(content, approach))
    return content


def content_of(found: Design, path: Path, rate: float) -> dict[str, Any]:
    """MOTION.json: `plantar.design/1`."""
    model, told = KelvinVoigt(), found.told
    values = {"stiffness": told.stiffness, "damping": told.damping}
    parameters = [
        {
            "foot": foot, "axis": axis, "name": name, "unit": model.unit(name, axis), "value": values[name],
            "half_width_percent": widths[found.nominal.factor],
            "error95_percent": max(filter(None, (one["error95_percent"] for one in at)), default=None),
            "at": at,
        }
        for foot in found.robot.feet
        for axis in ROTATIONAL_AXES
        for name in model.terms
        for widths in [promised.half_widths(found, axis, name)]
        for at in [[
            {"factor": one.factor, "half_width_percent": widths[one.factor],
             "error_percent": max(promised.errors(one, foot, axis, name, values[name]), key=abs, default=None),
             "error95_percent": promised.error95(one, found.robot.feet, axis, name, values[name]),
             "usable": promised.usable(one, foot, axis, name)}
            for one in found.rehearsals
        ]]
    ]  # fmt: skip
    way, speed = found.trajectory.limits_used()
    return {
        "schema": SCHEMA,
        "robot": found.robot.name,
        "motion": path.name,
        "settings": asdict(found.settings) | {"stiffness": told.stiffness, "damping": told.damping, "rate": rate},
        "stiffness_range": [factor * told.stiffness for factor in found.factors],
        "least_stiffness": found.least_stiffness,
        "right_foot_ahead": {"value": round(found.legs.ahead, 6), "unit": "m"},
        "one_foot": {"stands": False, "least_stiffness": len(found.robot.feet) * found.least_stiffness},
        "parameters": parameters,
        "wanted": {
            "stiffness_percent": 100 * WANTED[0],
            "damping_percent": 100 * WANTED[1],
            "sensor_delay": WANTED_DELAY,
            "vertical_compliance_percent": 100 * WANTED_VERTICAL,
        },
        "sensor_delay": {
            "unit": "s",
            "at": [
                {"factor": one.factor, "half_width": width, "error": error}
                for one in found.rehearsals
                for width, error in [promised.delay(one) or (None, None)]
            ],
        },
        "vertical_compliance": {
            "what": "sum of both feet",
            "value": len(found.robot.feet) / told.vertical,
            "unit": "m/N",
            "at": [
                {"factor": one.factor, "half_width_percent": width, "error_percent": error}
                for one in found.rehearsals
                for width, error in [promised.vertical(one, told.vertical) or (None, None)]
            ],
        },
        "rehearsals": [_rehearsal(one) for one in found.rehearsals],
        "notes": foretold(found, parameters),
        "self_collision": {"checked": found.pairs > 0, "pairs": found.pairs},
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
