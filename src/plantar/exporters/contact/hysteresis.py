"""Rubber that slips, beside MuJoCo's contact: what the file carries of it, and the loop that applies it.

A contact has no memory: its force follows from where the foot is and how fast. Slip is memory, so no `solref` holds it.
The file keeps the slip's numbers and the bush's place; the simulation's own loop adds the torque.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from plantar.conventions import Array, Axis
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.mjcf.file import Compiled
from plantar.exporters.spring import Slip
from plantar.exporters.xml_file import numbers

TURNS: Final[tuple[Axis, ...]] = ("roll", "pitch")  # in the order of the bush's axes x and y
SITE, NUMBERS = "_contact_bush", "_contact_slip"
# Cosine between a contact's normal and the sole's: what a sole stands on, not what a toe bumps into.
FACING: Final = 0.5


def take_out(root: ET.Element, foot: str) -> None:
    """Remove what an earlier export wrote of a foot's slip."""
    for parent in list(root.iter()):
        for child in parent.findall("site") + parent.findall("numeric"):
            if child.get("name") in (foot + SITE, foot + NUMBERS):
                parent.remove(child)


def carry(root: ET.Element, holder: ET.Element, foot: FootBush, model: Compiled) -> bool:
    """Write a foot's slip, if it has one: a site with the bush's axes in the body `holder`, and torque and angle of
    roll, then of pitch, as a <numeric>. Returns whether there was one."""
    slips = [spring.slip if (spring := foot.spring(axis)) else None for axis in TURNS]
    if not any(slips):
        return False
    name = str(holder.get("name"))
    centre = model.moved(foot.centre, foot.ankle, name)
    axes = [model.moved(foot.centre + foot.rotation[:, place], foot.ankle, name) - centre for place in (0, 1)]
    site = {"name": foot.name + SITE, "pos": numbers(centre), "xyaxes": numbers(np.concatenate(axes))}
    ET.SubElement(holder, "site", site | {"size": "0.001", "rgba": "0 0 0 0"})
    section = root.find("custom")
    section = ET.SubElement(root, "custom") if section is None else section
    data = [number for slip in slips for number in ((slip.torque, slip.angle) if slip else (0.0, 1.0))]
    ET.SubElement(section, "numeric", name=foot.name + NUMBERS, data=numbers(data))
    return True


@dataclass
class _Foot:
    """One foot's slip by axis, and how far each has yielded [rad]."""

    site: int
    body: int
    slips: tuple[Slip | None, ...]
    yielded: list[float]

    def torque(self, up: Array) -> Array:
        """On the foot, in the bush's axes (3,) [N·m]; `up`: the ground's normal in them. Call once a step."""
        x, y, z = up.tolist()
        pitch, found = math.atan2(x, z), [0.0, 0.0]
        for place, (angle, slip) in enumerate(zip((-math.asin(y), pitch), self.slips, strict=True)):
            if slip is None:
                continue
            elastic = max(-slip.angle, min(slip.angle, angle - self.yielded[place]))
            self.yielded[place] = angle - elastic
            found[place] = slip.stiffness * elastic
        # The sole turns as Ry(pitch) Rx(roll): roll is about the axis that pitch has turned.
        return np.array([found[0] * math.cos(pitch), found[1], -found[0] * math.sin(pitch)])


class FootHysteresis:
    """The slip of rubber feet in MuJoCo, on a model of `plantar export --to mujoco-contact --hysteresis`.

    Call it once a step between `mj_step1` and `mj_step2`: it writes the torque of `data.xfrc_applied` of each foot's
    body, the ground's on the foot, as an elastoplastic (Jenkins) element of the angle between foot and ground. A foot
    that touches nothing gets none, and forgets. One object for each `MjData`; for other integrators than RK4.

    Args:
        model: an `mujoco.MjModel` of the exported file.

    Raises:
        ExportError: the model carries no slip.

    Example:
        >>> import mujoco, plantar
        >>> result, out = "out/slipping/result.json", "out/robot_on_points.xml"
        >>> notes = plantar.export(result, "mujoco-contact", out, hysteresis=True)
        >>> model = mujoco.MjModel.from_xml_path(out)
        >>> data, hysteresis = mujoco.MjData(model), plantar.FootHysteresis(model)
        >>> for _ in range(100):
        ...     mujoco.mj_step1(model, data)
        ...     hysteresis(model, data)
        ...     mujoco.mj_step2(model, data)
    """

    def __init__(self, model: Any) -> None:
        self._feet = tuple(_feet(model))
        if not self._feet:
            valid = "a file of --to mujoco-contact --hysteresis, of rubber that slips"
            raise ExportError("the model carries no slip of its feet", valid=valid)

    def __call__(self, model: Any, data: Any) -> None:
        contact = data.contact
        bodies = model.geom_bodyid[contact.geom].reshape(-1, 2)
        normals = contact.frame.reshape(-1, 9)[:, :3]
        for foot in self._feet:
            turn = data.site_xmat[foot.site].reshape(3, 3)
            facing = normals @ turn[:, 2]
            ground = (bodies == foot.body).any(axis=1) & (np.abs(facing) > FACING)
            if not ground.any():
                foot.yielded = [0.0, 0.0]
                data.xfrc_applied[foot.body, 3:] = 0.0
                continue
            up = np.sign(facing[ground]) @ normals[ground] @ turn
            data.xfrc_applied[foot.body, 3:] = turn @ foot.torque(up / math.hypot(*up))

    def reset(self) -> None:
        """Forget what has slipped, after `mj_resetData`."""
        for foot in self._feet:
            foot.yielded = [0.0, 0.0]


def _feet(model: Any) -> list[_Foot]:
    found = []
    for place in range(model.nnumeric):
        numeric = model.numeric(place)
        if not numeric.name.endswith(NUMBERS):
            continue
        pairs = np.asarray(numeric.data).reshape(2, 2)
        slips = tuple(Slip(float(torque), float(angle)) if torque > 0 else None for torque, angle in pairs)
        site = model.site(numeric.name.removesuffix(NUMBERS) + SITE)
        found.append(_Foot(int(site.id), int(site.bodyid[0]), slips, [0.0, 0.0]))
    return found
