"""USD with UsdPhysics: a layer with each foot's bush as prismatic and revolute joints with drives.

UsdPhysics drives count angles in degrees: stiffness in N·m/deg, damping in N·m·s/deg, targets in degrees;
linear drives stay in N/m and N·s/m (openusd.org, UsdPhysicsDriveAPI; PhysX' USD parser multiplies the two by
180/pi). Isaac reads the same attributes. The joints go between a stand-in for the ankle and a light sole.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array
from plantar.exporters.bush import FootBush
from plantar.exporters.job import Job
from plantar.exporters.shapes import SOLE_INERTIA, SOLE_MASS, plate
from plantar.exporters.spring import Spring
from plantar.exporters.usd.conventions import AXIS, drive, identifier, quaternion
from plantar.notes import Notes

OPTIONAL_MODEL = True


def write(job: Job, notes: Notes) -> str:
    """The layer's text (.usda): the bushes alone, or overs on the job's stage.

    Raises ExportError: the stage cannot be opened or has not the ankles. MissingExtra: a stage, and no usd-core.
    """
    if job.model is not None:
        from plantar.exporters.usd.over import write as write_over

        return write_over(job, job.model, notes)
    text = (
        "the layer holds the bushes alone: reference each foot at its ankle, point body0 of its first joint to the "
        "robot's ankle, and switch the ankle's own sole collision off; --model with your stage does that"
    )
    notes.info("export_usd", text)
    lines = job.head("USD (angles per degree)", notes)
    body = "".join(_foot(foot) for foot in job.feet)
    header = ('#usda 1.0\n(\n    defaultPrim = "feet"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n'
              '    upAxis = "Z"\n)\n')  # fmt: skip
    comment = "".join(f"# {line}\n" for line in lines)
    return f'{header}{comment}\ndef Xform "feet"\n{{\n{_indent(body)}}}\n'


def _foot(foot: FootBush) -> str:
    name = identifier(foot.name)
    path = f"/feet/{name}"
    parts = [_link(identifier(foot.ankle), np.zeros(3), (1.0, 0.0, 0.0, 0.0), "", kinematic=True)]
    parent, place, turn = identifier(foot.ankle), foot.centre, quaternion(foot.rotation)
    for spring in foot.springs:
        child = identifier(foot.link(spring.axis))
        last = spring is foot.springs[-1]
        parts.append(_link(child, foot.centre, quaternion(foot.rotation), _plate(foot) if last else ""))
        joint = identifier(foot.joint(spring.axis))
        parts.append(_joint(joint, spring, f"{path}/{parent}", f"{path}/{child}", place, turn))
        parent, place, turn = child, np.zeros(3), (1.0, 0.0, 0.0, 0.0)
    return f'def Xform "{name}"\n{{\n{_indent("".join(parts))}}}\n'


def _link(name: str, place: Array, turn: tuple[float, ...], inside: str, *, kinematic: bool = False) -> str:
    lines = [
        f"double3 xformOp:translate = {_tuple(place)}",
        f"quatd xformOp:orient = {_tuple(turn)}",
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]',
        f"float physics:mass = {SOLE_MASS}",
        f"float3 physics:diagonalInertia = {_tuple([SOLE_INERTIA] * 3)}",
        "quatf physics:principalAxes = (1, 0, 0, 0)",  # the validator of USD wants both or neither
    ]
    if kinematic:
        lines.append("bool physics:kinematicEnabled = 1")
    body = "".join(f"{line}\n" for line in lines) + inside
    schemas = 'prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]'
    return f'def Xform "{name}" (\n    {schemas}\n)\n{{\n{_indent(body)}}}\n'


def _joint(name: str, spring: Spring, body0: str, body1: str, place: Array, turn: tuple[float, ...]) -> str:
    slide = spring.axis == "z"
    kind = "PhysicsPrismaticJoint" if slide else "PhysicsRevoluteJoint"
    unit, stiffness, damping, target = drive(spring)
    lines = [
        f"rel physics:body0 = <{body0}>",
        f"rel physics:body1 = <{body1}>",
        f'uniform token physics:axis = "{AXIS[spring.axis]}"',
        f"point3f physics:localPos0 = {_tuple(place)}",
        f"quatf physics:localRot0 = {_tuple(turn)}",
        "point3f physics:localPos1 = (0, 0, 0)",
        "quatf physics:localRot1 = (1, 0, 0, 0)",
        "bool physics:collisionEnabled = 0",
        f'uniform token drive:{unit}:physics:type = "force"',
        f"float drive:{unit}:physics:stiffness = {stiffness:.9g}",
        f"float drive:{unit}:physics:damping = {damping:.9g}",
        f"float drive:{unit}:physics:targetPosition = {target + 0.0:.9g}",
    ]
    body = "".join(f"{line}\n" for line in lines)
    schemas = f'prepend apiSchemas = ["PhysicsDriveAPI:{unit}"]'
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


def _tuple(values: Array | tuple[float, ...] | list[float]) -> str:
    return "(" + ", ".join(f"{float(value):.9g}" for value in values) + ")"


def _indent(text: str) -> str:
    return "".join(f"    {line}\n" for line in text.splitlines())
