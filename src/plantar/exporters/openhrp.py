"""OpenHRP and hrpsys: the configuration file of the bush customizer (BUSH_CUSTOMIZER_CONFIG_PATH).

Two properties, `robot_model_name` and `bush_config`, the second a list of joint,spring,damping with N/m,
N/(m/s) for slides and N·m/rad, N·m/(rad/s) for hinges (openhrp3, sample/example/customizer).
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass

from plantar.errors import ExportError
from plantar.exporters.job import Job
from plantar.files import read_bounded
from plantar.notes import Notes
from plantar.robot.urdf import LIMIT


@dataclass(frozen=True)
class Customizer:
    """A bush customizer's configuration: the robot's name, and spring and damper of each joint in the file's order.

    `joints`: by name (K, C), in N/m and N·s/m for slides, N·m/rad and N·m·s/rad for hinges.
    """

    robot: str
    joints: dict[str, tuple[float, float]]


def read_customizer(path: str | os.PathLike[str]) -> Customizer:
    """The configuration in a file, as OpenHRP and hrpsys read it: other keys and comments are passed over.

    Raises ExportError: a file that cannot be read, without `bush_config`, or with an entry that is no joint with two
    numbers that are not negative, or the same joint twice.

    Example:
        >>> from plantar.exporters.openhrp import read_customizer
        >>> _ = open("bush.conf", "w").write("bush_config: LLEG_BUSH_Z,5e5,1e3 LLEG_BUSH_ROLL,1e3,25")
        >>> read_customizer("bush.conf").joints["LLEG_BUSH_ROLL"]
        (1000.0, 25.0)
    """
    text = read_bounded(path, LIMIT, ExportError).decode(errors="replace")
    found: dict[str, tuple[int, str]] = {}
    for place, line in enumerate(text.splitlines(), start=1):
        key, colon, value = line.partition("#")[0].partition(":")
        if colon:
            found[key.strip()] = (place, value.strip())
    if "bush_config" not in found:
        raise ExportError("has no 'bush_config'", path=path, valid="a bush customizer's configuration")
    place, config = found["bush_config"]
    joints: dict[str, tuple[float, float]] = {}
    for entry in config.split():
        name, *numbers = entry.split(",")
        try:
            spring, damper = (float(number) for number in numbers)
        except ValueError:
            spring = damper = math.nan
        if name in joints or not (0 <= spring < math.inf and 0 <= damper < math.inf):
            message = f"line {place}: '{entry[:60]}' is no entry of 'bush_config'"
            raise ExportError(message, path=path, valid="each joint once: joint,spring,damping")
        joints[name] = (spring, damper)
    return Customizer(found.get("robot_model_name", (0, ""))[1], joints)


def write(job: Job, notes: Notes) -> str:
    """The configuration's text."""
    entries = [
        f"{foot.joint(s.axis)},{s.stiffness:.9g},{s.damping:.9g}"
        for foot in job.feet
        for s in sorted(foot.springs, key=lambda s: ("z", "roll", "pitch").index(s.axis))
    ]
    notes.info("export_openhrp", "the joints named must be in the robot's VRML or body file")
    if job.with_offset:
        notes.warning("export_offset", "the bush customizer has no rest position: offsets left out")
    lines = job.head("the bush customizer", notes, rests=False)
    name = str(job.result.get("robot", "robot"))
    comment = "".join(f"# {line}\n" for line in lines)
    return f"{comment}robot_model_name: {name}\nbush_config: {' '.join(entries)}\n"
