"""An MJCF on disk and as MuJoCo sees it: includes pasted in, paths absolute, shapes in body frames."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from plantar.choices import nearest
from plantar.conventions import Array
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.shapes import reaches_sole
from plantar.exporters.urdf.geometry import box_corners
from plantar.exporters.xml_file import load_xml
from plantar.notes import Notes

INCLUDE_LIMIT = 100  # files pasted into one model


def load_mjcf(path: Path, notes: Notes) -> ET.Element:
    """The model's XML with its includes pasted in and its asset directories made absolute."""
    root = load_xml(path, "mujoco")
    pasted: list[str] = []
    _paste(root, path.parent, pasted)
    if pasted:
        notes.info("export_includes", f"included files were pasted in: {', '.join(pasted)}")
    compiler = root.find("compiler")
    if compiler is None:
        compiler = ET.Element("compiler")
        root.insert(0, compiler)
    base = path.parent.resolve()
    shared = compiler.attrib.pop("assetdir", "")
    for key in ("meshdir", "texturedir"):
        compiler.set(key, str(base / compiler.get(key, shared)))
    return root


def _paste(parent: ET.Element, base: Path, pasted: list[str]) -> None:
    for index, child in reversed(list(enumerate(parent))):
        if child.tag == "include":
            if len(pasted) >= INCLUDE_LIMIT:
                raise ExportError(f"includes more than {INCLUDE_LIMIT} files", path=base)
            name = child.get("file", "")
            pasted.append(name)
            inner = ET.Element("mujoco")
            inner.extend(_children(base / name))
            _paste(inner, base, pasted)
            parent[index : index + 1] = list(inner)
        elif isinstance(child.tag, str):
            _paste(child, base, pasted)


def _children(path: Path) -> list[ET.Element]:
    for tag in ("mujoco", "mujocoinclude"):
        try:
            return list(load_xml(path, tag))
        except ExportError as error:
            if tag == "mujocoinclude" or "is not a <" not in str(error):
                raise
    return []


def relocate(root: ET.Element, out: Path) -> None:
    """Asset directories as seen from where the new file will stand."""
    compiler = root.find("compiler")
    for key in ("meshdir", "texturedir"):
        if compiler is not None and compiler.get(key):
            compiler.set(key, os.path.relpath(compiler.get(key, ""), out.resolve().parent))


class Compiled:
    """MuJoCo's view of the XML at its reference pose, with static bodies kept apart."""

    def __init__(self, root: ET.Element, path: Path) -> None:
        import mujoco

        self.path = path
        try:
            spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
            spec.compiler.fusestatic = False
            self.model: Any = spec.compile()
            self.data: Any = mujoco.MjData(self.model)
            mujoco.mj_kinematics(self.model, self.data)
        except (ValueError, TypeError, mujoco.FatalError) as error:
            reason = " ".join(str(error).split())[:300]
            raise ExportError(f"MuJoCo refuses the model: {reason}", path=path) from error
        self._mesh_type = mujoco.mjtGeom.mjGEOM_MESH
        self._plane_type = int(mujoco.mjtGeom.mjGEOM_PLANE)
        self.degrees = bool(spec.compiler.degree)
        self.inertia_from_geoms = int(spec.compiler.inertiafromgeom) == int(
            mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
        )

    def _id(self, kind: str, name: str) -> int:
        import mujoco

        return int(mujoco.mj_name2id(self.model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), name))

    def has_body(self, name: str) -> bool:
        return self._id("BODY", name) >= 0

    def has_joint(self, name: str) -> bool:
        return self._id("JOINT", name) >= 0

    def body_element(self, root: ET.Element, name: str) -> ET.Element:
        """The <body> of that name; ExportError names the nearest that are there."""
        elements = {body.get("name", ""): body for body in root.iter("body")}
        if name not in elements:
            message = f"has no body '{name}' (the ankle link of the robot file)"
            raise ExportError(
                message, path=self.path, valid=nearest(name, elements) or "a model of the robot"
            )
        return elements[name]

    def geom_elements(self, body: ET.Element, name: str) -> Iterator[tuple[ET.Element, int]]:
        """A body's <geom> elements with MuJoCo's index of each."""
        index = self._id("BODY", name)
        first, count = int(self.model.body_geomadr[index]), int(self.model.body_geomnum[index])
        elements = body.findall("geom")
        if len(elements) != count:
            message = f"body '{name}' makes its geoms by <frame>, <replicate> or <composite>"
            raise ExportError(message, path=self.path, valid="geoms that stand in the body itself")
        return zip(elements, range(first, first + count), strict=True)

    def _in_body(self, points: Array, body: str) -> Array:
        index = self._id("BODY", body)
        local: Array = (points - self.data.xpos[index]) @ self.data.xmat[index].reshape(3, 3)
        return local

    def geom_points(self, geom: int, body: str) -> Array:
        """A geom's extreme points in a body's frame, (n, 3): vertices, or corners of its box."""
        model = self.model
        mesh = int(model.geom_dataid[geom])
        if int(model.geom_type[geom]) == int(self._mesh_type) and mesh >= 0:
            first = int(model.mesh_vertadr[mesh])
            points = np.asarray(model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])], float)
        else:
            points = box_corners(2 * model.geom_aabb[geom][3:]) + model.geom_aabb[geom][:3]
        world = points @ self.data.geom_xmat[geom].reshape(3, 3).T + self.data.geom_xpos[geom]
        return self._in_body(world, body)

    def moved(self, point: Array, body: str, other: str) -> Array:
        """A point (3,) of a body's frame in another body's frame, at the reference pose."""
        index = self._id("BODY", body)
        return self._in_body(self.data.xmat[index].reshape(3, 3) @ point + self.data.xpos[index], other)

    def _subtree(self, name: str) -> list[int]:
        inside = {self._id("BODY", name)}
        for body in range(self.model.nbody):
            if int(self.model.body_parentid[body]) in inside and body:
                inside.add(body)
        return sorted(inside)

    def subtree_points(self, name: str, body: str) -> Array:
        """Extreme points of all geoms of a body and what hangs on it, in another body's frame, (n, 3)."""
        geoms = [
            geom
            for geom in range(self.model.ngeom)
            if int(self.model.geom_bodyid[geom]) in self._subtree(name)
        ]
        return np.concatenate([np.empty((0, 3)), *(self.geom_points(geom, body) for geom in geoms)])

    def reaching(self, foot: FootBush) -> list[Array]:
        """Points in the ankle's frame of each collision shape there and below that reaches the sole."""
        bodies = self._subtree(foot.ankle)
        model = self.model
        geoms = [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) in bodies
                 and (model.geom_contype[g] or model.geom_conaffinity[g])]  # fmt: skip
        points = [self.geom_points(geom, foot.ankle) for geom in geoms]
        return [corners for corners in points if reaches_sole(corners, foot)]

    def body_origin(self, name: str, body: str) -> Array:
        return self._in_body(self.data.xpos[self._id("BODY", name)], body)

    def site_origin(self, name: str) -> Array:
        """A site's position in its own body's frame, (3,)."""
        return np.array(self.model.site_pos[self._id("SITE", name)])

    def inertia(self, body: str) -> tuple[float, Array, Array, Array]:
        """Mass, centre of mass, orientation w x y z and principal moments of a body."""
        index, m = self._id("BODY", body), self.model
        return (float(m.body_mass[index]), np.array(m.body_ipos[index]), np.array(m.body_iquat[index]),
                np.array(m.body_inertia[index]))  # fmt: skip

    def robot_mass(self, body: str) -> float:
        """What the robot that a body belongs to weighs [kg], without what else is in the scene."""
        root = int(self.model.body_rootid[self._id("BODY", body)])
        return float(self.model.body_subtreemass[root])

    def inverse_mass(self, body: str) -> float:
        """MuJoCo's inverse mass of a body at the reference pose, along any axis [1/kg]: what scales its contacts."""
        return float(self.model.body_invweight0[self._id("BODY", body), 0])

    def friction_on_floor(self, geom: int) -> Array:
        """Friction (3,) of a geom on the model's floor: of the one of higher priority, else the larger."""
        model = self.model
        planes = [g for g in range(model.ngeom) if int(model.geom_type[g]) == self._plane_type]
        own = np.array(model.geom_friction[geom])
        if not planes:
            return own
        floor = np.array(model.geom_friction[planes[0]])
        ahead = int(model.geom_priority[geom]) - int(model.geom_priority[planes[0]])
        return own if ahead > 0 else floor if ahead < 0 else np.maximum(own, floor)

    def neighbours(self, body: str) -> list[str]:
        """Named bodies whose contacts with `body` MuJoCo filters: its weld group's parent and children."""
        model = self.model
        weld = model.body_weldid
        mine = int(weld[self._id("BODY", body)])
        above = int(weld[model.body_parentid[mine]])
        near = {mine, above} - {0}
        others = (int(weld[body]) for body in range(1, model.nbody))
        near |= {other for other in others if int(weld[model.body_parentid[other]]) == mine}
        names = [model.body(b).name for b in range(1, model.nbody) if int(weld[b]) in near]
        return [name for name in names if name]

    def size(self, attribute: str) -> int:
        return int(self.model.nq if attribute == "qpos" else self.model.nv)

    def address(self, joint: str, attribute: str) -> int:
        """Index of a one-dof joint's entry in qpos or qvel."""
        addresses = self.model.jnt_qposadr if attribute == "qpos" else self.model.jnt_dofadr
        return int(addresses[self._id("JOINT", joint)])
