"""USD with UsdPhysics: a layer with each foot's bush as prismatic and revolute joints with drives.

UsdPhysics drives count angles in degrees: stiffness in N·m/deg, damping in N·m·s/deg, targets in degrees;
linear drives stay in N/m and N·s/m (openusd.org, UsdPhysicsDriveAPI; PhysX' USD parser multiplies the two by
180/pi). Isaac reads the same attributes. The joints go between a stand-in for the ankle and a light sole.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array
from plantar.exporters.bush import FootBush
from plantar.exporters.comment import head
from plantar.exporters.shapes import SOLE_INERTIA, SOLE_MASS, plate
from plantar.exporters.spring import Spring
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.exporters.job import Job

AXIS = {"z": "Z", "pitch": "Y", "roll": "X"}
PER_DEGREE = math.pi / 180


def write(job: Job) -> tuple[str, tuple[Note, ...]]:
    """The layer's text (.usda)."""
    text = ("the layer holds the bushes alone: reference it, point body0 of each foot's first joint "
            "to the robot's ankle, and switch the ankle's own sole collision off")  # fmt: skip
    notes = (Note("export_usd", "info", text),)
    lines = head(
        job.result, job.feet, "USD (angles per degree)", (*job.remarks, *notes), with_offset=job.with_offset
    )
    body = "".join(_foot(foot) for foot in job.feet)
    header = ('#usda 1.0\n(\n    defaultPrim = "feet"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n'
              '    upAxis = "Z"\n)\n')  # fmt: skip
    comment = "".join(f"# {line}\n" for line in lines)
    return f'{header}{comment}\ndef Xform "feet"\n{{\n{_indent(body)}}}\n', notes


def _foot(foot: FootBush) -> str:
    name = _identifier(foot.name)
    path = f"/feet/{name}"
    parts = [_link(_identifier(foot.ankle), np.zeros(3), (1.0, 0.0, 0.0, 0.0), "", kinematic=True)]
    parent, place, turn = _identifier(foot.ankle), foot.centre, _quaternion(foot.rotation)
    for spring in foot.springs:
        child = _identifier(foot.link(spring.axis))
        last = spring is foot.springs[-1]
        parts.append(_link(child, foot.centre, _quaternion(foot.rotation), _plate(foot) if last else ""))
        parts.append(
            _joint(foot.joint(spring.axis), spring, f"{path}/{parent}", f"{path}/{child}", place, turn)
        )
        parent, place, turn = child, np.zeros(3), (1.0, 0.0, 0.0, 0.0)
    return f'def Xform "{name}"\n{{\n{_indent("".join(parts))}}}\n'


def _link(name: str, place: Array, turn: tuple[float, ...], inside: str, *, kinematic: bool = False) -> str:
    lines = [
        f"double3 xformOp:translate = {_tuple(place)}",
        f"quatd xformOp:orient = {_tuple(turn)}",
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]',
        f"float physics:mass = {SOLE_MASS}",
        f"float3 physics:diagonalInertia = {_tuple([SOLE_INERTIA] * 3)}",
    ]
    if kinematic:
        lines.append("bool physics:kinematicEnabled = 1")
    body = "".join(f"{line}\n" for line in lines) + inside
    schemas = 'prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]'
    return f'def Xform "{name}" (\n    {schemas}\n)\n{{\n{_indent(body)}}}\n'


def _joint(name: str, spring: Spring, body0: str, body1: str, place: Array, turn: tuple[float, ...]) -> str:
    slide = spring.axis == "z"
    kind, drive = ("PhysicsPrismaticJoint", "linear") if slide else ("PhysicsRevoluteJoint", "angular")
    factor = 1.0 if slide else PER_DEGREE
    lines = [
        f"rel physics:body0 = <{body0}>",
        f"rel physics:body1 = <{body1}>",
        f'uniform token physics:axis = "{AXIS[spring.axis]}"',
        f"point3f physics:localPos0 = {_tuple(place)}",
        f"quatf physics:localRot0 = {_tuple(turn)}",
        "point3f physics:localPos1 = (0, 0, 0)",
        "quatf physics:localRot1 = (1, 0, 0, 0)",
        "bool physics:collisionEnabled = 0",
        f'uniform token drive:{drive}:physics:type = "force"',
        f"float drive:{drive}:physics:stiffness = {spring.stiffness * factor:.9g}",
        f"float drive:{drive}:physics:damping = {spring.damping * factor:.9g}",
        f"float drive:{drive}:physics:targetPosition = {spring.rest / factor:.9g}",
    ]
    body = "".join(f"{line}\n" for line in lines)
    schemas = f'prepend apiSchemas = ["PhysicsDriveAPI:{drive}"]'
    return f'def {kind} "{name}" (\n    {schemas}\n)\n{{\n{_indent(body)}}}\n'


def _plate(foot: FootBush) -> str:
    size, centre = plate(foot)
    lines = [
        "double size = 1",
        f"double3 xformOp:translate = {_tuple(centre)}",
        f"float3 xformOp:scale = {_tuple(size)}",
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]',
    ]
    body = "".join(f"{line}\n" for line in lines)
    return f'def Cube "plate" (\n    prepend apiSchemas = ["PhysicsCollisionAPI"]\n)\n{{\n{_indent(body)}}}\n'


def _identifier(name: str) -> str:
    """USD prim names hold letters, digits and underscores and start with no digit."""
    clean = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name)
    return clean if clean and not clean[0].isdigit() else f"_{clean}"


def _quaternion(rotation: Array) -> tuple[float, ...]:
    """A rotation matrix as w, x, y, z, by the largest of the four."""
    r = rotation
    squares = np.array([1 + np.trace(r), *(1 + 2 * np.diag(r) - np.trace(r))])
    big = int(np.argmax(squares))
    columns = np.array([
        [squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], squares[1], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
        [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], squares[2], r[1, 2] + r[2, 1]],
        [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[3]],
    ])  # fmt: skip
    return tuple(float(value) for value in columns[big] / np.linalg.norm(columns[big]))


def _tuple(values: Array | tuple[float, ...] | list[float]) -> str:
    return "(" + ", ".join(f"{float(value):.9g}" for value in values) + ")"


def _indent(text: str) -> str:
    return "".join(f"    {line}\n" for line in text.splitlines())
