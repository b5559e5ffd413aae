"""Overs on a robot's own stage: a layer above it in which the ankles stand on bush joints.

The user's stage is a sublayer and stays as it is: its scene, its joints and their drives. What is added stands in the
layer alone: light bodies and joints below each ankle, a plate under the sole with the material of the shapes that
stood on the ground, and `collisionEnabled = false` on those.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from plantar.conventions import Array
from plantar.exporters.bush import FootBush
from plantar.exporters.comment import plate_note
from plantar.exporters.job import Job
from plantar.exporters.shapes import SOLE_INERTIA, SOLE_MASS, plate
from plantar.exporters.spring import Spring
from plantar.exporters.usd.conventions import AXIS, drive, identifier, quaternion
from plantar.exporters.usd.stage import ankle_of, layer_above, quiet, standing_shapes, text_of, with_scene
from plantar.notes import Notes


def write(job: Job, model: Path, notes: Notes) -> str:
    """The text (.usda) of the layer above the stage at `model`.

    Raises ExportError: no stage, other units than metre and kilogram, no rigid body of an ankle's name. MissingExtra:
    no usd-core.
    """
    layer, above = layer_above(model)
    for foot in job.feet:
        _insert(above, foot, model, notes)
    with_scene(above, notes)
    return text_of(layer, job.head("USD", notes), model, job.out)


def _insert(stage: Any, foot: FootBush, model: Path, notes: Notes) -> None:
    ankle = ankle_of(stage, foot, model)
    holder = _without_body(ankle)
    place = _relative(ankle, holder)
    centre = place[:3, :3] @ foot.centre + place[:3, 3]
    turn = place[:3, :3] @ foot.rotation
    there = bool(stage.GetPrimAtPath(holder.GetPath().AppendChild(identifier(foot.sole_link))))
    shapes = standing_shapes(ankle, foot)
    above, at, rotated = ankle, foot.centre, foot.rotation
    for spring in foot.springs:
        link = _link(stage, holder, identifier(foot.link(spring.axis)), centre, turn)
        _joint(stage, holder, foot.joint(spring.axis), spring, (above, link), at, rotated)
        above, at, rotated = link, np.zeros(3), np.eye(3)
    _plate(stage, above, foot, shapes)
    quiet(stage, shapes)
    _filter(above, ankle)
    if there:
        return
    _lighter(ankle, SOLE_MASS * len(foot.springs))
    if shapes:
        paths = ", ".join(str(shape.GetPath()) for shape in shapes)
        notes.info("export_plate", f"{foot.name}: a plate touches the ground now, not {paths}")
    else:
        notes.append(plate_note(foot))


def _without_body(ankle: Any) -> Any:
    """The nearest prim above that is in no rigid body: bodies must not stand in each other."""
    from pxr import UsdPhysics

    holder, above = ankle.GetParent(), ankle.GetParent()
    while above and not above.IsPseudoRoot():
        if above.HasAPI(UsdPhysics.RigidBodyAPI):
            holder = above.GetParent()
        above = above.GetParent()
    return holder


def _relative(prim: Any, other: Any) -> Array:
    """Pose (4, 4) of a prim in another's frame, its scale taken off."""
    from pxr import UsdGeom

    cache = UsdGeom.XformCache()
    matrix = cache.GetLocalToWorldTransform(prim) * cache.GetLocalToWorldTransform(other).GetInverse()
    return np.array(matrix.RemoveScaleShear()).T


def _link(stage: Any, holder: Any, name: str, centre: Array, turn: Array) -> Any:
    from pxr import Gf, UsdGeom, UsdPhysics

    link = UsdGeom.Xform.Define(stage, holder.GetPath().AppendChild(name))
    link.ClearXformOpOrder()
    link.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*map(float, centre)))
    link.AddOrientOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Quatd(*quaternion(turn)))
    UsdPhysics.RigidBodyAPI.Apply(link.GetPrim())
    mass = UsdPhysics.MassAPI.Apply(link.GetPrim())
    mass.CreateMassAttr(SOLE_MASS)
    mass.CreateDiagonalInertiaAttr(Gf.Vec3f(SOLE_INERTIA))
    mass.CreatePrincipalAxesAttr(Gf.Quatf(1.0))
    return link.GetPrim()


def _joint(
    stage: Any, holder: Any, name: str, spring: Spring, bodies: tuple[Any, Any], at: Array, turn: Array
) -> None:
    from pxr import Gf, UsdPhysics

    kind = UsdPhysics.PrismaticJoint if spring.axis == "z" else UsdPhysics.RevoluteJoint
    joint = kind.Define(stage, holder.GetPath().AppendChild(identifier(name)))
    joint.CreateBody0Rel().SetTargets([bodies[0].GetPath()])
    joint.CreateBody1Rel().SetTargets([bodies[1].GetPath()])
    joint.CreateAxisAttr(AXIS[spring.axis])
    joint.CreateLocalPos0Attr(Gf.Vec3f(*map(float, at)))
    joint.CreateLocalRot0Attr(Gf.Quatf(*quaternion(turn)))
    joint.CreateLocalPos1Attr(Gf.Vec3f(0.0))
    joint.CreateLocalRot1Attr(Gf.Quatf(1.0))
    joint.CreateCollisionEnabledAttr(False)
    unit, stiffness, damping, target = drive(spring)
    pushed = UsdPhysics.DriveAPI.Apply(joint.GetPrim(), unit)
    pushed.CreateTypeAttr("force")
    pushed.CreateStiffnessAttr(stiffness)
    pushed.CreateDampingAttr(damping)
    pushed.CreateTargetPositionAttr(target)


def _plate(stage: Any, sole: Any, foot: FootBush, shapes: list[Any]) -> None:
    from pxr import Gf, UsdGeom, UsdPhysics, UsdShade

    size, centre = plate(foot)
    made = UsdGeom.Cube.Define(stage, sole.GetPath().AppendChild("plate"))
    made.CreateSizeAttr(1.0)
    made.CreateExtentAttr([Gf.Vec3f(-0.5), Gf.Vec3f(0.5)])
    made.ClearXformOpOrder()
    made.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*map(float, centre)))
    made.AddScaleOp(UsdGeom.XformOp.PrecisionFloat).Set(Gf.Vec3f(*map(float, size)))
    UsdPhysics.CollisionAPI.Apply(made.GetPrim())
    for shape in shapes:
        material = UsdShade.MaterialBindingAPI(shape).ComputeBoundMaterial("physics")[0]
        if material and not material.GetPrim().IsInstanceProxy():
            binding = UsdShade.MaterialBindingAPI.Apply(made.GetPrim())
            binding.Bind(material, UsdShade.Tokens.weakerThanDescendants, "physics")
            return


def _filter(sole: Any, ankle: Any) -> None:
    from pxr import UsdPhysics

    UsdPhysics.FilteredPairsAPI.Apply(sole).CreateFilteredPairsRel().SetTargets([ankle.GetPath()])


def _lighter(ankle: Any, mass: float) -> None:
    """Take the new bodies' mass off the ankle where the stage gives it one."""
    from pxr import UsdPhysics

    attribute = UsdPhysics.MassAPI(ankle).GetMassAttr()
    old = attribute.Get() if attribute and attribute.HasAuthoredValue() else 0.0
    if old > 2 * mass:
        attribute.Set(old - mass)
