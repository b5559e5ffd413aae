"""What MuJoCo's contact cannot be of a foot on rubber: what the file carries of it, and the loop that applies it.

A contact has no memory: its force follows from where the foot is and how fast. Slip is memory, so no `solref` holds it.
Points that damp pitch damp z as well, those that leave the ground hold no more, and they do not tip as the sole does.
The file keeps the bush's numbers, its place and the sole; the simulation's own loop adds what the points lack.
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
from plantar.exporters.contact.bush_on_sole import BushOnSole
from plantar.exporters.contact.points import PointFoot
from plantar.exporters.mjcf.file import Compiled
from plantar.exporters.spring import DAMPING_TIME, Slip
from plantar.exporters.xml_file import child_of, numbers

TURNS: Final[tuple[Axis, ...]] = ("roll", "pitch")  # in the order of the bush's axes x and y
SITE, NUMBERS = "_contact_bush", "_contact_law"
# Cosine between a contact's normal and the sole's: what a sole stands on, not what a toe bumps into.
FACING: Final = 0.5


def take_out(root: ET.Element, foot: str) -> None:
    """Remove what an earlier export wrote of a foot's slip."""
    for parent in list(root.iter()):
        for child in parent.findall("site") + parent.findall("numeric"):
            if child.get("name") in (foot + SITE, foot + NUMBERS):
                parent.remove(child)


def carry(
    root: ET.Element, holder: ET.Element, foot: FootBush, turn: Array, points: PointFoot, model: Compiled
) -> None:
    """Write the law of a foot: a site with the bush's axes in the body `holder`, and a <numeric>.

    The axes are turned by the springs' rest angles, `turn` (3, 3), as the points are. In the <numeric>: the height of
    the bush centre at which the ground carries nothing; stiffness, then damping, of z, roll and pitch; torque and angle
    of the slip of roll, then of pitch, 0 and 1 where there is none; x and y of the sole's corners. What was not
    identified is as the points have it.
    """
    slips = [spring.slip if (spring := foot.spring(axis)) else None for axis in TURNS]
    name = str(holder.get("name"))
    centre = model.moved(foot.centre, foot.ankle, name)
    turned = foot.rotation @ turn
    axes = [model.moved(foot.centre + turned[:, place], foot.ankle, name) - centre for place in (0, 1)]
    site = {"name": foot.name + SITE, "pos": numbers(centre), "xyaxes": numbers(np.concatenate(axes))}
    ET.SubElement(holder, "site", site | {"size": "0.001", "rgba": "0 0 0 0"})
    up = points.vertical[0]
    own = (up, DAMPING_TIME * up), *(points.turning(axis) for axis in TURNS)
    springs = [foot.spring("z"), *(foot.spring(axis) for axis in TURNS)]
    law = [(s.stiffness, s.damping) if s else held for s, held in zip(springs, own, strict=True)]
    free = points.depth + points.first_load / law[0][0]
    data = [free, *(k for k, _ in law), *(c for _, c in law)]
    data += [number for slip in slips for number in ((slip.torque, slip.angle) if slip else (0.0, 1.0))]
    data += ((foot.sole - foot.centre) @ foot.rotation)[:, :2].ravel().tolist()
    ET.SubElement(child_of(root, "custom"), "numeric", name=foot.name + NUMBERS, data=numbers(data))


@dataclass(frozen=True)
class _Foot:
    """One foot's law, the site of its bush, its body and the tree's root, and the height of the bush centre over the
    ground at which nothing is carried [m]."""

    site: int
    body: int
    root: int
    free: float
    law: BushOnSole

    def wrench(self, up: Array, height: float, climb: float, turning: Array) -> tuple[float, Array]:
        """Force along the ground's normal [N] and torque in the bush's axes (3,) [N·m], the ground's on the foot.

        Args:
            up: the ground's normal in the bush's axes (3,). height, climb: of the bush centre over the ground, and its
                rate [m, m/s]. turning: rate of the foot in the bush's axes (3,) [rad/s].
        """
        x, y, z = up.tolist()
        pitch = math.atan2(x, z)
        deflection = np.array([self.free - height, -math.asin(y), pitch])
        force, roll_torque, pitch_torque = self.law.wrench(
            deflection, np.array([-climb, -turning[0], -turning[1]])
        )
        # The sole turns as Ry(pitch) Rx(roll): roll is about the axis that pitch has turned.
        torque = [roll_torque * math.cos(pitch), pitch_torque, -roll_torque * math.sin(pitch)]
        return float(force), np.array(torque)


class FootHysteresis:
    """What points cannot be of rubber feet in MuJoCo, on a model of `plantar export --to mujoco-contact --hysteresis`.

    Call it once a step between `mj_step1` and `mj_step2`: it writes `data.xfrc_applied` of each foot's body: how the
    ground pushes beyond what the points do. That is the slip, an elastoplastic (Jenkins) element of the angle between
    foot and ground; K where points have left the ground; less damping along z; and a sole that tips. A foot that
    touches nothing gets none, and forgets. One object for each `MjData`; for other integrators than RK4.

    Args:
        model: an `mujoco.MjModel` of the exported file.

    Raises:
        ExportError: the model carries no law of its feet.

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
            valid = "a file of --to mujoco-contact --hysteresis"
            raise ExportError("the model carries no law of its feet", valid=valid)
        self._springs = _springs(model)
        bodies = [foot.body for foot in self._feet]
        self._owners = np.array([bodies.index(one) if one in bodies else -1 for one in model.geom_bodyid])

    def __call__(self, model: Any, data: Any) -> None:
        contact = data.contact
        geoms, at, sunk = contact.geom, contact.pos, -contact.dist
        normals = contact.frame.reshape(-1, 9)[:, :3]
        owners = self._owners[geoms].reshape(-1, 2)
        for place, foot in enumerate(self._feet):
            turn = data.site_xmat[foot.site].reshape(3, 3)
            mine = owners == place
            facing = normals @ turn[:, 2]
            ground = np.flatnonzero(mine.any(axis=1) & (np.abs(facing) > FACING))
            if not ground.size:
                foot.law.forget()
                data.xfrc_applied[foot.body] = 0.0
                continue
            normal = np.sign(facing[ground]) @ normals[ground]
            normal /= math.sqrt(normal @ normal)
            arms = at[ground] - (site := data.site_xpos[foot.site])
            turning, moving = data.cvel[foot.body, :3], data.cvel[foot.body, 3:]
            # Rates along the normal, of the bush centre and of the points that touch.
            leaning = _crossed(normal, turning)
            climb = float(moving @ normal + (site - data.subtree_com[foot.root]) @ leaning)
            stiffness, damping = self._springs[geoms[ground][mine[ground]]].T
            pushes = np.maximum(stiffness * sunk[ground] - damping * (arms @ leaning + climb), 0.0)
            height = -float(arms[0] @ normal + sunk[ground[0]] / 2)  # a contact stands half way in
            force, torque = foot.wrench(normal @ turn, height, climb, turning @ turn)
            lacking = (force - pushes.sum()) * normal
            applied = data.xfrc_applied[foot.body]
            applied[:3] = lacking
            applied[3:] = turn @ torque - _crossed(pushes @ arms, normal)
            applied[3:] += _crossed(site - data.xipos[foot.body], lacking)

    def reset(self) -> None:
        """Forget what has slipped, after `mj_resetData`."""
        for foot in self._feet:
            foot.law.forget()


def _crossed(a: Array, b: Array) -> Array:
    """a × b, (3,): a tenth of the time of NumPy's."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def _springs(model: Any) -> Array:
    """Stiffness and damping [N/m, N·s/m] of each geom's contact, (n, 2): of `alone.contact_attributes`."""
    first, second = np.asarray(model.geom_solref).T
    inverse_mass = (1 - model.geom_solimp[:, 0]) * model.body_invweight0[model.geom_bodyid, 0]
    direct = first <= 0
    with np.errstate(divide="ignore", invalid="ignore"):
        k, c = np.where(direct, -first, (first * second) ** -2.0), np.where(direct, -second, 2 / first)
        return np.asarray(np.column_stack([k, c]) / inverse_mass[:, None])


def _feet(model: Any) -> list[_Foot]:
    found = []
    for place in range(model.nnumeric):
        numeric = model.numeric(place)
        if not numeric.name.endswith(NUMBERS):
            continue
        data = np.array(numeric.data)
        pairs, corners = data[7:11].reshape(2, 2), data[11:].reshape(-1, 2)
        roll, pitch = (Slip(float(torque), float(angle)) if torque > 0 else None for torque, angle in pairs)
        site = model.site(numeric.name.removesuffix(NUMBERS) + SITE)
        law = BushOnSole(data[1:4], data[4:7], (roll, pitch), corners)
        body = int(site.bodyid[0])
        found.append(_Foot(int(site.id), body, int(model.body_rootid[body]), float(data[0]), law))
    return found
