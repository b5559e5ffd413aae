"""A URDF as SDFormat 1.8: each joint posed in its parent link, each link at its joint."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection
from pathlib import Path

from plantar.conventions import Array
from plantar.errors import ExportError
from plantar.exporters.job import Job
from plantar.exporters.sdf.tree import SdfTree, set_pose
from plantar.exporters.urdf.tree import UrdfTree, origin_of
from plantar.exporters.xml_file import numbers, vector
from plantar.notes import Notes

JOINT_TYPES = {"fixed", "revolute", "continuous", "prismatic"}


def tree_of(job: Job, notes: Notes, meshes: Collection[str] | None = None) -> SdfTree:
    """The job's model, with its ankles; `meshes` as of `sdf_from_urdf`, for a model that is a URDF."""
    assert job.model is not None
    ankles = tuple(foot.ankle for foot in job.feet)
    if job.model.suffix.lower() == ".urdf":
        return SdfTree(sdf_from_urdf(job.model, notes, meshes), job.model, ankles)
    return SdfTree.load(job.model, ankles)


def sdf_from_urdf(path: Path, notes: Notes, meshes: Collection[str] | None) -> ET.Element:
    """The URDF's links, joints, inertias and shapes. ExportError: a joint of another type.

    `meshes`: endings of mesh files that the reader takes; shapes of others are left out with a note.
    """
    tree = UrdfTree.load(path)
    root = ET.Element("sdf", version="1.8")
    model = ET.SubElement(root, "model", name=tree.root.get("name", "robot"))
    # SDFormat knows the world without a link, and stands a model in it by the model's own pose.
    tree.let_go(notes)
    carriers = {tree.ends(joint)[1]: name for name, joint in tree.joints.items()}
    if meshes is not None:
        _drop_meshes(tree, meshes, notes)
    for name, link in tree.links.items():
        element = ET.SubElement(model, "link", name=name)
        if name in carriers:
            ET.SubElement(element, "pose", relative_to=carriers[name])
        _inertial(element, link)
        for tag in ("collision", "visual"):
            for index, shape in enumerate(link.findall(tag)):
                _shape(element, tag, f"{name}_{tag}_{index}", shape, tree)
    for name, joint in tree.joints.items():
        _joint(model, name, joint, tree)
    if any(joint.find("mimic") is not None for joint in tree.joints.values()):
        notes.warning("export_mimic", "mimic joints became free joints: SDFormat words them by engine")
    notes.info("export_urdf", f"made from {path.name}; sensors, transmissions and plugins did not come along")
    return root


def _drop_meshes(tree: UrdfTree, meshes: Collection[str], notes: Notes) -> None:
    lost = []
    for link in tree.links.values():
        for shape in (*link.findall("collision"), *link.findall("visual")):
            mesh = shape.find("geometry/mesh")
            if mesh is not None and Path(mesh.get("filename", "")).suffix.lower() not in meshes:
                link.remove(shape)
                lost.append(mesh.get("filename", "").rsplit("/", 1)[-1])
    if lost:
        text = f"{len(lost)} meshes that are not {', '.join(meshes)} left out: {', '.join(lost[:3])} ..."
        notes.warning("export_mesh", text)


def _inertial(element: ET.Element, link: ET.Element) -> None:
    inertial = link.find("inertial")
    if inertial is None:
        return
    made = ET.SubElement(element, "inertial")
    set_pose(made, origin_of(inertial))
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    ET.SubElement(made, "mass").text = "0" if mass is None else mass.get("value", "0")
    tensor = ET.SubElement(made, "inertia")
    for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        ET.SubElement(tensor, key).text = "0" if inertia is None else inertia.get(key, "0")


def _shape(element: ET.Element, tag: str, name: str, shape: ET.Element, tree: UrdfTree) -> None:
    geometry = shape.find("geometry")
    if geometry is None or len(geometry) == 0:
        return
    made = ET.SubElement(element, tag, name=name)
    set_pose(made, origin_of(shape))
    kind = geometry[0]
    part = ET.SubElement(ET.SubElement(made, "geometry"), kind.tag)
    if kind.tag == "mesh":
        found = tree.mesh_file(kind.get("filename", ""))
        ET.SubElement(part, "uri").text = kind.get("filename", "") if found is None else f"file://{found}"
        scale: Array = vector(kind.get("scale"), 3, "scale", 1.0)
        ET.SubElement(part, "scale").text = numbers(scale)
    else:
        for key, value in kind.attrib.items():
            ET.SubElement(part, key).text = value


def _joint(model: ET.Element, name: str, joint: ET.Element, tree: UrdfTree) -> None:
    kind = joint.get("type", "")
    if kind not in JOINT_TYPES:
        message = f"joint '{name}' is of a type that is not carried over"
        raise ExportError(message, path=tree.path, value=kind, valid=", ".join(sorted(JOINT_TYPES)))
    parent, child = tree.ends(joint)
    made = ET.SubElement(model, "joint", name=name, type="revolute" if kind == "continuous" else kind)
    set_pose(made, origin_of(joint), parent)
    ET.SubElement(made, "parent").text = parent
    ET.SubElement(made, "child").text = child
    if kind == "fixed":
        return
    axis, limit, dynamics = joint.find("axis"), joint.find("limit"), joint.find("dynamics")
    part = ET.SubElement(made, "axis")
    ET.SubElement(part, "xyz").text = "1 0 0" if axis is None else axis.get("xyz", "1 0 0")
    if limit is not None:
        bounds = ET.SubElement(part, "limit")
        keys = ("effort", "velocity") if kind == "continuous" else ("lower", "upper", "effort", "velocity")
        for key in keys:
            if limit.get(key) is not None:
                ET.SubElement(bounds, key).text = limit.get(key)
    if dynamics is not None:
        values = ET.SubElement(part, "dynamics")
        for key in ("damping", "friction"):
            ET.SubElement(values, key).text = dynamics.get(key, "0")
