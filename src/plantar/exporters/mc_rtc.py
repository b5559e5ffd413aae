"""mc_rtc: the `flexibilities` of a robot module.

mc_rbdyn::Flexibility (jointName, K, C, O) stands for torque = -K q - C q̇ - O in the flexible joint, and RobotModule's
JSON reads a list of them under `flexibilities` (mc_rtc, mc_rbdyn/Flexibility.h and configuration_io.cpp). The joint
pushes back what the ground puts on the sole, so K, C and O are the identified ones.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass

from plantar.errors import ExportError
from plantar.exporters.job import Job
from plantar.files import read_bounded
from plantar.notes import Notes
from plantar.robot.urdf import LIMIT


@dataclass(frozen=True)
class Flexibility:
    """One flexible joint of a robot module: stiffness [N·m/rad, N/m], damping [N·m·s/rad, N·s/m], offset [N·m, N].

    With plantar's signs: what the ground puts on the sole is K·deflection + C·rate + offset.
    """

    stiffness: float
    damping: float
    offset: float


def read_flexibilities(path: str | os.PathLike[str]) -> dict[str, Flexibility]:
    """The flexible joints of a robot module in JSON, by joint name.

    Raises ExportError: a file that cannot be read, without `flexibilities`, or with an entry that is no joint with
    three finite numbers K, C >= 0 and O, or the same joint twice.

    Example:
        >>> from plantar.exporters.mc_rtc import read_flexibilities
        >>> entry = '{"jointName": "LLEG_BUSH_ROLL", "K": 352, "C": 28, "O": -4.1}'
        >>> _ = open("module.json", "w").write('{"flexibilities": [' + entry + "]}")
        >>> read_flexibilities("module.json")["LLEG_BUSH_ROLL"].stiffness
        352.0
    """
    try:
        data = json.loads(read_bounded(path, LIMIT, ExportError))
    except (ValueError, RecursionError) as error:
        raise ExportError("is not JSON", path=path, valid="a robot module of mc_rtc") from error
    entries = data.get("flexibilities") if isinstance(data, dict) else None
    if not isinstance(entries, list):
        raise ExportError("has no list 'flexibilities'", path=path, valid="a robot module of mc_rtc")
    found: dict[str, Flexibility] = {}
    for place, entry in enumerate(entries, start=1):
        try:
            name, values = str(entry["jointName"]), [float(entry[key]) for key in ("K", "C", "O")]
        except (TypeError, KeyError, ValueError):
            name, values = "", [math.nan]
        if not name or name in found or not all(map(math.isfinite, values)) or min(values[:2]) < 0:
            message = f"flexibility {place} is no joint with K, C and O"
            raise ExportError(message, path=path, valid="each jointName once; K, C not negative")
        found[name] = Flexibility(*values)
    return found


def write(job: Job, notes: Notes) -> str:
    """The JSON to merge into a robot module; the key `plantar`, which no reader asks for, stands for comments."""
    flexibilities = [
        {"jointName": foot.joint(s.axis), "K": s.stiffness, "C": s.damping, "O": s.offset}
        for foot in job.feet
        for s in foot.springs
    ]
    notes.info("export_mc_rtc", "the joints named must be in the module's URDF: export --to urdf writes them")
    content = {"plantar": job.head("mc_rtc", notes), "flexibilities": flexibilities}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
