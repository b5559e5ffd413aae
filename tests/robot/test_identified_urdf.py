"""Inertias in a URDF: a body's sum on its heaviest link, whatever link's frame it was given about."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest

from plantar.errors import PlantarError
from plantar.robot.identified_urdf import write_inertias

INERTIA = '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
URDF = f"""<robot name="arm">
  <link name="base"/>
  <link name="torso"><inertial><mass value="5"/>{INERTIA}</inertial></link>
  <link name="cover"><inertial><mass value="0.5"/>{INERTIA}</inertial></link>
  <link name="forearm"><inertial><mass value="1"/>{INERTIA}</inertial></link>
  <joint name="mount" type="fixed"><parent link="base"/><child link="torso"/>
    <origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/></joint>
  <joint name="screws" type="fixed"><parent link="torso"/><child link="cover"/><origin xyz="0 0 0.2"/></joint>
  <joint name="elbow" type="continuous"><parent link="torso"/><child link="forearm"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 1 0"/></joint>
</robot>"""


@pytest.fixture
def model() -> pin.Model:
    return pin.buildModelFromXML(URDF, pin.JointModelFreeFlyer())


def body(seed: int) -> np.ndarray:
    pin.seed(seed)
    return np.asarray(pin.Inertia.Random().toDynamicParameters())


def carriers(root: ET.Element) -> set[str | None]:
    return {link.get("name") for link in root.findall("link") if link.find("inertial") is not None}


@pytest.mark.parametrize("named", ["base", "torso", "cover"])
def test_a_body_is_the_same_whichever_of_its_links_names_it(named: str, model: pin.Model) -> None:
    root, wanted, forearm = ET.fromstring(URDF), body(1), body(2)
    notes = write_inertias(root, model, {named: wanted, "forearm": forearm})
    assert carriers(root) == {"torso", "forearm"}
    assert "cover" in next(note.text for note in notes if note.code == "export_lumped")
    again = pin.buildModelFromXML(ET.tostring(root, encoding="unicode"), pin.JointModelFreeFlyer())
    placement = model.frames[model.getFrameId(named, pin.FrameType.BODY)].placement
    about_base = placement.act(pin.Inertia.FromDynamicParameters(wanted)).toDynamicParameters()
    np.testing.assert_allclose(again.inertias[1].toDynamicParameters(), about_base, atol=1e-12)
    np.testing.assert_allclose(again.inertias[2].toDynamicParameters(), forearm, atol=1e-12)


def test_written_twice_it_stands_where_it_stood(model: pin.Model) -> None:
    root = ET.fromstring(URDF)
    write_inertias(root, model, {"base": body(1)})
    first = ET.tostring(root)
    assert write_inertias(root, model, {"base": body(1)}) == ()
    assert ET.tostring(root) == first


def test_a_body_without_mass_stays_without(model: pin.Model) -> None:
    root = ET.fromstring(URDF)
    assert "export_inertia" not in {
        note.code for note in write_inertias(root, model, {"forearm": np.zeros(10)})
    }
    link = next(link for link in root.findall("link") if link.get("name") == "forearm")
    assert link.find("inertial/mass").get("value") == "0.0"  # type: ignore[union-attr]
    assert link.find("inertial/origin").get("xyz") == "0.0 0.0 0.0"  # type: ignore[union-attr]


def test_what_no_body_can_have_is_said_and_a_negative_mass_refused(model: pin.Model) -> None:
    flat = np.array([1.0, 0, 0, 0, 0.1, 0, 0.1, 0, 0, 0.3])
    notes = write_inertias(ET.fromstring(URDF), model, {"forearm": flat})
    assert [note.code for note in notes] == ["export_inertia"]
    with pytest.raises(
        PlantarError,
        match=r"^link 'forearm' has the identified mass -1 kg \(valid: a mass that is not negative\)$",
    ):
        write_inertias(ET.fromstring(URDF), model, {"forearm": -flat})
    with pytest.raises(
        PlantarError, match=r"^the URDF has no link 'hand' \(valid: base, torso, cover, forearm\)$"
    ):
        write_inertias(ET.fromstring(URDF), model, {"hand": flat})
