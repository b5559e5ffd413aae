"""The user's model as MJCF; a URDF by MuJoCo's own importer: what a newcomer has is a URDF."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

from plantar.errors import ExportError, needs
from plantar.exporters.bush import FootBush
from plantar.exporters.job import Job
from plantar.exporters.mjcf.file import load_mjcf
from plantar.exporters.urdf.tree import UrdfTree
from plantar.exporters.xml_file import child_of
from plantar.notes import Notes

MESHES = {".stl", ".obj"}  # what MuJoCo's importer reads
STIFF = "0.004 1"  # solref of every shape: at MuJoCo's own 0.02 the contact is as soft as some bushes


def opened(job: Job, purpose: str, notes: Notes) -> ET.Element:
    """The job's model as MJCF, whether it is that or a URDF.

    Raises ExportError when MuJoCo refuses it, MissingExtra, with the `purpose`, without mujoco.
    """
    with needs("mujoco", "twin", purpose):
        import mujoco  # noqa: F401
    assert job.model is not None
    if job.model.suffix.lower() == ".urdf":
        return mjcf_from_urdf(job.model, job.feet, notes)
    return load_mjcf(job.model, notes)


def mjcf_from_urdf(path: Path, feet: tuple[FootBush, ...], notes: Notes) -> ET.Element:
    """The URDF's XML as MJCF: floating base, collision shapes only, a floor, and the base at standing height.

    Raises ExportError when MuJoCo refuses the URDF.
    """
    import mujoco

    tree = UrdfTree.load(path)
    tree.let_go(notes)
    lost = _collision_only(tree)
    if lost:
        text = "meshes MuJoCo cannot read, left out, so those links touch nothing"
        notes.warning("export_mesh", f"{text}: {', '.join(lost[:4])}")
    compiler = child_of(child_of(tree.root, "mujoco"), "compiler")
    compiler.attrib |= {"fusestatic": "false", "discardvisual": "true", "strippath": "false"}
    try:
        spec = _import(tree, compiler, notes)
        children = {tree.ends(joint)[1] for joint in tree.joints.values()}
        root = next(name for name in tree.links if name not in children)
        base = spec.body(root)
        base.add_freejoint()
        base.pos = [0, 0, _standing_height(spec, feet)]
        text = spec.to_xml()
    except (ValueError, TypeError, StopIteration, AttributeError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())[:300]
        raise ExportError(f"MuJoCo refuses the URDF: {reason}", path=path) from error
    model = ET.fromstring(text)
    world = model.find("worldbody")
    if world is not None:
        world.insert(0, ET.Element("light", pos="0 0 4", dir="0 0 -1", directional="true"))
        world.insert(0, ET.Element("geom", name="floor", type="plane", size="0 0 0.05"))
        for geom in world.iter("geom"):
            geom.set("solref", STIFF)
    child_of(model, "option").attrib |= {"timestep": "0.001", "integrator": "implicitfast"}
    notes.info("export_urdf", f"made from {path.name} with a floor, without actuators or visual shapes")
    return model


def _collision_only(tree: UrdfTree) -> list[str]:
    """Take visual shapes and unreadable meshes out; returns the names of the collision meshes lost."""
    lost = []
    for link in tree.links.values():
        for visual in link.findall("visual"):
            link.remove(visual)
        for collision in link.findall("collision"):
            mesh = collision.find("geometry/mesh")
            if mesh is None:
                continue
            name = mesh.get("filename", "")
            found = tree.mesh_file(name)
            if found is None or found.suffix.lower() not in MESHES:
                link.remove(collision)
                lost.append(name.rsplit("/", 1)[-1])
            else:
                mesh.set("filename", str(found))
    return lost


def _import(tree: UrdfTree, compiler: ET.Element, notes: Notes) -> Any:
    """MuJoCo's spec of the URDF; a second try mends inertias that no rigid body can have."""
    import mujoco

    def spec() -> Any:
        made = mujoco.MjSpec.from_string(ET.tostring(tree.root, encoding="unicode"))
        made.copy().compile()
        return made

    try:
        return spec()
    except (ValueError, mujoco.FatalError) as error:
        text = "moments of inertia that no body can have were set to their mean, masses below 0.1 g and moments below "
        text += f"1e-7 kg·m² raised to that: MuJoCo says {' '.join(str(error).split())[:120]}"
        compiler.attrib |= {"balanceinertia": "true", "boundmass": "1e-4", "boundinertia": "1e-7"}
        made = spec()
        notes.warning("export_inertia", text)
        return made


def _standing_height(spec: Any, feet: tuple[FootBush, ...]) -> float:
    """Height of the base at which the lowest sole touches z = 0 at the reference pose [m]."""
    import mujoco

    model = spec.copy().compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    heights = []
    for foot in feet:
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, foot.ankle)
        if body >= 0:
            corners = foot.sole @ data.xmat[body].reshape(3, 3).T + data.xpos[body]
            heights.append(float(corners[:, 2].min()))
    return -min(heights, default=0.0)
