"""state-observation's Kinetics Observer: stiffness and damping of the contacts.

Four vectors x, y, z: `linStiffness` [N/m], `linDamping` [N·s/m], `angStiffness` [N·m/rad], `angDamping`
[N·m·s/rad], one set for all contacts (mc_state_observation, etc/MCKineticsObserver/robots). What no
recording gave stands at the observer's own defaults: 40000, 120, 400, 12.

The observer's wrench on the robot is -(K·(p - p₀) + C·v) and -(K·sin θ·axis + C·ω), so K and C are plantar's, positive,
per radian at small angles (state-observation, kinetics-observer.cpp). But it takes p, θ and ω along the world's axes: x
is roll and y pitch only as long as the robot faces the world's x.
"""

from __future__ import annotations

import os

import numpy as np
import yaml

from plantar.conventions import Axis
from plantar.errors import ExportError
from plantar.exporters.job import Job
from plantar.files import read_bounded
from plantar.notes import Notes
from plantar.robot.urdf import LIMIT

# Key -> (attribute of the spring, axes in order x y z, the observer's default).
ENTRIES: dict[str, tuple[str, tuple[Axis | None, ...], float]] = {
    "linStiffness": ("stiffness", (None, None, "z"), 40000.0),
    "angStiffness": ("stiffness", ("roll", "pitch", None), 400.0),
    "linDamping": ("damping", (None, None, "z"), 120.0),
    "angDamping": ("damping", ("roll", "pitch", None), 12.0),
}


def read_contacts(path: str | os.PathLike[str]) -> dict[Axis, tuple[float, float]]:
    """K and C by axis in an observer's YAML: pitch, roll [N·m/rad, N·m·s/rad] and z [N/m, N·s/m].

    Raises ExportError: a file that cannot be read, or without one of the four vectors of three numbers.

    Example:
        >>> from plantar.exporters.kinetics_observer import read_contacts
        >>> text = "linStiffness: [4e4, 4e4, 4e4]\\nangStiffness: [338, 457, 400]\\n"
        >>> text += "linDamping: [120, 120, 120]\\nangDamping: [23, 20, 12]\\n"
        >>> _ = open("observer.yaml", "w").write(text)
        >>> read_contacts("observer.yaml")["pitch"]
        (457.0, 20.0)
    """
    try:
        data = yaml.safe_load(read_bounded(path, LIMIT, ExportError))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise ExportError("is not YAML", path=path, valid="an observer's configuration") from error
    found = {}
    for key in ENTRIES:
        try:
            values = np.array(data[key], float)
        except (TypeError, KeyError, ValueError):
            values = np.empty(0)
        if values.shape != (3,) or not np.isfinite(values).all() or values.min() < 0:
            raise ExportError(f"'{key}' is not three numbers", path=path, valid="x, y, z, none negative")
        found[key] = [float(value) for value in values]
    places: tuple[tuple[Axis, str, int], ...] = (("roll", "ang", 0), ("pitch", "ang", 1), ("z", "lin", 2))
    return {
        axis: (found[f"{kind}Stiffness"][place], found[f"{kind}Damping"][place])
        for axis, kind, place in places
    }


def write(job: Job, notes: Notes) -> str:
    """The YAML's text."""
    text = "the observer takes one set for all contacts: means over the feet were written"
    notes.warning("export_mean", text)
    text = "what was not identified (horizontal, yaw, z where missing) stands at the observer's defaults"
    notes.warning("export_default", text)
    text = "the observer's x and y are the world's: roll and pitch of a robot that faces the world's x"
    notes.info("export_world", text)
    if job.with_offset:
        notes.warning("export_offset", "the observer has no rest position: offsets left out")
    body = ""
    for key, (attribute, axes, default) in ENTRIES.items():
        values = []
        for axis in axes:
            found = [spring for foot in job.feet if axis and (spring := foot.spring(axis)) is not None]
            known = [getattr(spring, attribute) for spring in found]
            values.append(float(np.mean(known)) if known else default)
        body += f"{key}: [{', '.join(f'{value:.9g}' for value in values)}]\n"
    lines = job.head("the Kinetics Observer", notes, rests=False, joints=False)
    return "".join(f"# {line}\n" for line in lines) + body
