"""PhysX' compliant contact: a USD layer above a stage, spheres under each ankle with a material of their own.

`physxMaterial:compliantContactStiffness` [N/m] and `compliantContactDamping` [N·s/m] of a material make its shapes push
as spring and damper (PhysX, PxMaterial; the schema PhysxMaterialAPI). Isaac reads the same attributes. The user's stage
is a sublayer and stays as it is.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from plantar.conventions import GRAVITY
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.springs import (
    FRICTION,
    RADIUS,
    Placed,
    placed,
    said,
    share_of_friction,
    sliding_note,
    spring_foot,
)
from plantar.exporters.job import Job
from plantar.exporters.usd.conventions import identifier
from plantar.exporters.usd.stage import ankle_of, layer_above, quiet, standing_shapes, text_of, with_scene
from plantar.notes import Notes

OPTIONAL_MODEL = True


def write(job: Job, notes: Notes) -> str:
    """The text (.usda) of the layer above the job's stage.

    Raises ExportError: no stage given, one that cannot be opened, has not the ankles, or whose bodies have no mass.
    MissingExtra: no usd-core.
    """
    if job.model is None:
        raise ExportError("PhysX' contact goes onto a stage", valid="--model with the robot's USD stage")
    layer, stage = layer_above(job.model)
    weight = _mass(stage, ankle_of(stage, job.feet[0], job.model), job.model) * GRAVITY
    for foot in job.feet:
        made = spring_foot(foot, weight)
        points = placed(foot, made, weight)
        _insert(stage, foot, points, job.model, notes)
        notes += [*said(foot, made, weight), *sliding_note(foot, points)]
    with_scene(stage, notes)
    text = "the ground's own material stays rigid; PhysX' solver TGS takes 5 to 6 % off K, PGS at most 2 % "
    text += "(physxScene:solverType)"
    notes.info("export_physx", text)
    return text_of(layer, job.head("PhysX' contact", notes, joints=False), job.model, job.out)


def _mass(stage: Any, ankle: Any, model: Path) -> float:
    """Of the bodies that joints tie to the ankle [kg]: what else is in the scene does not stand on the feet."""
    from pxr import UsdPhysics

    bodies = {prim.GetPath(): prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.RigidBodyAPI)}
    ties = [
        {*joint.GetBody0Rel().GetTargets(), *joint.GetBody1Rel().GetTargets()} & bodies.keys()
        for joint in map(UsdPhysics.Joint, stage.Traverse())
        if joint
    ]
    tied, before = {ankle.GetPath()}, 0
    while len(tied) > before:
        before, tied = len(tied), tied.union(*(ends for ends in ties if ends & tied))
    masses = {str(path): UsdPhysics.MassAPI(bodies[path]).GetMassAttr().Get() or 0.0 for path in sorted(tied)}
    bare = [path for path, mass in masses.items() if mass <= 0]
    if bare:
        message = f"a rigid body has no mass: {bare[0]}"
        raise ExportError(message, path=model, valid="physics:mass on every rigid body")
    return float(sum(masses.values()))


def _insert(stage: Any, foot: FootBush, points: list[Placed], model: Path, notes: Notes) -> None:
    from pxr import UsdPhysics, UsdShade

    ankle = ankle_of(stage, foot, model)
    start = identifier(f"{foot.name}_contact_")
    for old in ankle.GetChildren():  # of an earlier export
        if old.GetName().startswith(start):
            old.SetActive(False)
    shapes = standing_shapes(ankle, foot)
    friction = FRICTION
    for shape in shapes:
        bound = UsdShade.MaterialBindingAPI(shape).ComputeBoundMaterial("physics")[0]
        if bound and (given := UsdPhysics.MaterialAPI(bound).GetDynamicFrictionAttr().Get()) is not None:
            friction = float(given)
    quiet(stage, shapes)
    if shapes:
        named = ", ".join(str(shape.GetPath()) for shape in shapes)
        notes.info("export_silent", f"{foot.name}: these touch nothing any more, the points do: {named}")
    outer = friction * share_of_friction(points)
    for point in points:
        _add(stage, ankle, point, 0.0 if point.middle else outer)


def _add(stage: Any, ankle: Any, placed: Placed, friction: float) -> None:
    from pxr import Gf, Sdf, UsdGeom, UsdPhysics, UsdShade

    made = UsdGeom.Sphere.Define(stage, ankle.GetPath().AppendChild(identifier(placed.name)))
    made.GetPrim().SetActive(True)
    made.CreateRadiusAttr(RADIUS)
    made.CreateExtentAttr([Gf.Vec3f(-RADIUS), Gf.Vec3f(RADIUS)])
    made.ClearXformOpOrder()
    made.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*map(float, placed.centre)))
    made.CreatePurposeAttr(UsdGeom.Tokens.guide)
    UsdPhysics.CollisionAPI.Apply(made.GetPrim())
    material = UsdShade.Material.Define(stage, made.GetPath().AppendChild("material"))
    prim = material.GetPrim()
    physics = UsdPhysics.MaterialAPI.Apply(prim)
    physics.CreateStaticFrictionAttr(friction)
    physics.CreateDynamicFrictionAttr(friction)
    physics.CreateRestitutionAttr(0.0)
    prim.AddAppliedSchema("PhysxMaterialAPI")
    for name, value in (
        ("compliantContactStiffness", placed.point.stiffness),
        ("compliantContactDamping", placed.point.damping),
    ):
        prim.CreateAttribute(f"physxMaterial:{name}", Sdf.ValueTypeNames.Float).Set(value)
    if friction == 0:  # whatever the ground's material asks for: nothing rubs
        name = Sdf.ValueTypeNames.Token
        prim.CreateAttribute(
            "physxMaterial:frictionCombineMode", name, variability=Sdf.VariabilityUniform
        ).Set("multiply")
    binding = UsdShade.MaterialBindingAPI.Apply(made.GetPrim())
    binding.Bind(material, UsdShade.Tokens.weakerThanDescendants, "physics")
