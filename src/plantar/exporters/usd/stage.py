"""A user's USD stage and the layer above it: opened, its ankles and the shapes that stand on the ground."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from plantar.choices import nearest
from plantar.errors import ExportError, needs
from plantar.exporters.bush import FootBush
from plantar.exporters.shapes import reaches_sole
from plantar.exporters.urdf.geometry import box_corners
from plantar.exporters.usd.conventions import identifier
from plantar.notes import Notes


def layer_above(model: Path) -> tuple[Any, Any]:
    """A new layer with the stage at `model` as its sublayer, and the stage that both make.

    Raises ExportError: no stage, other units than metre and kilogram. MissingExtra: no usd-core.
    """
    with needs("pxr", "usd", "export to a USD stage"):
        from pxr import Sdf, Usd
    stage = opened(model)
    layer = Sdf.Layer.CreateAnonymous(".usda")
    layer.subLayerPaths.append(str(model.resolve()))
    above = Usd.Stage.Open(layer)
    for name in ("upAxis", "metersPerUnit", "kilogramsPerUnit"):
        above.SetMetadata(name, stage.GetMetadata(name))
    if stage.HasDefaultPrim():
        above.SetDefaultPrim(above.GetPrimAtPath(stage.GetDefaultPrim().GetPath()))
    return layer, above


def text_of(layer: Any, lines: list[str], model: Path, out: Path) -> str:
    """The layer as it will stand at `out`, with `lines` as its documentation."""
    layer.documentation = "\n".join(lines)
    # Relative to where the layer will stand, as a stage that is moved as a whole needs it.
    layer.subLayerPaths[0] = Path(os.path.relpath(model.resolve(), out.resolve().parent)).as_posix()
    return str(layer.ExportToString())


def opened(model: Path) -> Any:
    """The stage in a file. ExportError: unreadable, or in other units than metre and kilogram."""
    from pxr import Tf, Usd, UsdGeom, UsdPhysics

    try:
        stage = Usd.Stage.Open(str(model))
    except Tf.ErrorException as error:
        raise ExportError("USD cannot open the stage", path=model, valid="a USD stage") from error
    units = UsdGeom.GetStageMetersPerUnit(stage), UsdPhysics.GetStageKilogramsPerUnit(stage)
    if not np.allclose(units, 1.0):
        message = f"one unit of the stage is {units[0]:g} m and {units[1]:g} kg"
        raise ExportError(message, path=model, valid="metersPerUnit = 1 and kilogramsPerUnit = 1")
    return stage


def ankle_of(stage: Any, foot: FootBush, model: Path) -> Any:
    """The foot's ankle, a rigid body. ExportError where the stage has none or several of its name."""
    from pxr import UsdPhysics

    bodies = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.RigidBodyAPI)]
    found = [prim for prim in bodies if prim.GetName() == identifier(foot.ankle)]
    if len(found) == 1:
        return found[0]
    if found:
        paths = ", ".join(str(prim.GetPath()) for prim in found)
        message = f"has several rigid bodies '{foot.ankle}': {paths}"
        raise ExportError(message, path=model, valid="a stage with one robot")
    names = [prim.GetName() for prim in bodies]
    message = f"has no rigid body '{foot.ankle}' (the ankle link of the robot file)"
    raise ExportError(
        message, path=model, valid=nearest(identifier(foot.ankle), names) or "a stage of the robot"
    )


def standing_shapes(ankle: Any, foot: FootBush) -> list[Any]:
    """Shapes of the ankle that collide and reach down to the sole."""
    from pxr import Usd, UsdGeom, UsdPhysics

    boxes = UsdGeom.BBoxCache(
        Usd.TimeCode.Default(), [UsdGeom.Tokens.default_, UsdGeom.Tokens.guide, UsdGeom.Tokens.proxy]
    )
    found = []
    for prim in Usd.PrimRange(ankle, Usd.TraverseInstanceProxies()):
        if not prim.HasAPI(UsdPhysics.CollisionAPI):
            continue
        box = boxes.ComputeRelativeBound(prim, ankle).ComputeAlignedRange()
        low, high = np.array(box.GetMin()), np.array(box.GetMax())
        if np.all(high >= low) and reaches_sole(box_corners(high - low) + (high + low) / 2, foot):
            found.append(prim)
    return found


def quiet(stage: Any, shapes: list[Any]) -> None:
    """Take contact from shapes; those of an instance are set apart from it first."""
    from pxr import UsdPhysics

    for path in [shape.GetPath() for shape in shapes]:
        while (prim := stage.GetPrimAtPath(path)).IsInstanceProxy():
            above = prim
            while not above.IsInstance():
                above = above.GetParent()
            above.SetInstanceable(False)
        UsdPhysics.CollisionAPI(prim).CreateCollisionEnabledAttr(False)


def with_scene(stage: Any, notes: Notes) -> None:
    """Add a physics scene where there is none."""
    from pxr import UsdPhysics

    if not any(prim.IsA(UsdPhysics.Scene) for prim in stage.Traverse()):
        UsdPhysics.Scene.Define(stage, "/physicsScene")
        notes.info("export_scene", "the stage had no PhysicsScene; one was added")
