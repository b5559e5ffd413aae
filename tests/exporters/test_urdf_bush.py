"""The bush in a URDF, each element whole: what a simulator reads of it, and nothing else."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

from plantar.exporters import export

LIGHT = """<inertial><mass value="0.05" />
<inertia ixx="0.0001" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0001" /></inertial>"""
FIRST, MIDDLE, SOLE = "left_bush_z_link", "left_bush_pitch_link", "left_bush_sole"


def same(found: ET.Element | None, wanted: str) -> None:
    """As XML, whatever the blanks between its elements."""
    assert found is not None
    one, other = (
        ET.canonicalize(ET.tostring(each), strip_text=True) for each in (found, ET.fromstring(wanted))
    )
    assert one == other


@pytest.mark.parametrize(
    ("axis", "kind", "at", "parent", "child", "way", "reach", "damping", "stiffness"),
    [
        ("Z", "prismatic", ("0.01 0 -0.08", "0 0 0.3"), "left_ankle", FIRST, "0 0 1", 0.05, 400, 40000),
        ("PITCH", "revolute", ("0 0 0", "0 0 0"), FIRST, MIDDLE, "0 1 0", 0.6, 24.27, 480),
        ("ROLL", "revolute", ("0 0 0", "0 0 0"), MIDDLE, SOLE, "1 0 0", 0.6, 28.15, 352),
    ],
)
def test_a_bush_is_a_chain_of_joints_and_light_links(
    axis: str, kind: str, at: tuple[str, str], parent: str, child: str, way: str, reach: float,
    damping: float, stiffness: float, feet: dict[str, Any], tmp_path: Path,
) -> None:  # fmt: skip
    export(feet, "urdf", tmp_path / "out.urdf")
    root, name = ET.parse(tmp_path / "out.urdf").getroot(), f"LLEG_BUSH_{axis}"
    same(
        root.find(f"joint[@name='{name}']"),
        f"""<joint name="{name}" type="{kind}"><origin xyz="{at[0]}" rpy="{at[1]}" />
        <parent link="{parent}" /><child link="{child}" /><axis xyz="{way}" />
        <limit lower="-{reach}" upper="{reach}" effort="100000" velocity="1000" />
        <dynamics damping="{damping}" friction="0" /></joint>""",
    )
    same(root.find(f"link[@name='{child}']/inertial"), LIGHT)
    same(
        root.find(f"gazebo[@reference='{name}']"),
        f"""<gazebo reference="{name}"><springStiffness>{stiffness}</springStiffness>
        <springReference>0</springReference><implicitSpringDamper>true</implicitSpringDamper></gazebo>""",
    )
