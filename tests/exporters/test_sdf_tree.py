"""An SDFormat model as a tree: which links are fixed to one, how far shapes reach, where meshes lie."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from export_robots import write_urdf
from plantar.errors import ExportError
from plantar.exporters.sdf.from_urdf import sdf_from_urdf
from plantar.exporters.sdf.tree import SdfTree, pose_of
from plantar.notes import Notes

SDF = """
<sdf version="1.9"><model name="arm">
  <link name="ankle"><pose>0 0 1 0 0 0</pose><inertial><mass>2</mass></inertial>
    <collision name="foot"><pose degrees="true">1 2 3 0 0 90</pose><geometry>{shape}</geometry></collision>
  </link>
  <link name="cell"><pose relative_to="glue">0 0 0 0 0 0</pose><inertial><mass>0.5</mass></inertial></link>
  <link name="toe"/><link name="free"/>
  <joint name="glue" type="fixed"><pose relative_to="ankle">0.1 0 -0.2 0 0 0</pose>
    <parent>ankle</parent><child>cell</child></joint>
  <joint name="hinge" type="revolute"><parent>ankle</parent><child>toe</child></joint>
  <joint name="other" type="fixed"><parent>cell</parent><child>free</child></joint>
</model></sdf>
"""


def tree_of(folder: Path, shape: str = "<sphere><radius>0.1</radius></sphere>") -> SdfTree:
    path = folder / "arm.sdf"
    path.write_text(SDF.format(shape=shape))
    return SdfTree.load(path, ("ankle",))


def test_fixed_children_are_glued_to_this_link(tmp_path: Path) -> None:
    tree = tree_of(tmp_path)
    assert [(joint.get("name"), child) for joint, child in tree.fixed_children("ankle")] == [("glue", "cell")]
    assert [child for _, child in tree.fixed_children("cell")] == ["free"]
    assert tree.fixed_children("toe") == []
    assert tree.parents("toe") == ["ankle"]
    assert tree.mass() == 2.5
    np.testing.assert_allclose(tree.in_model("cell")[:3, 3], [0.1, 0, 0.8])


def test_of_a_robot_beside_another_the_first_is_extended(tmp_path: Path) -> None:
    other = SDF.partition("<model")[2].rpartition("</sdf>")[0].replace('name="arm"', 'name="other"')
    path = tmp_path / "two.sdf"
    path.write_text(
        SDF.format(shape="<sphere/>").replace("</sdf>", f"<model{other.format(shape='<sphere/>')}</sdf>")
    )
    assert SdfTree.load(path, ("ankle",)).model.get("name") == "arm"


@pytest.mark.parametrize(
    "inside", ["", "<world><include><uri>arm</uri></include></world>", "<model name='arm'/>"]
)
def test_a_file_without_links_of_its_own_says_what_would_be_valid(tmp_path: Path, inside: str) -> None:
    path = tmp_path / "none.sdf"
    path.write_text(f'<sdf version="1.9">{inside}</sdf>')
    with pytest.raises(
        ExportError, match=r"no model with the link 'ankle' \(valid: a <model> with the robot's"
    ):
        SdfTree.load(path, ("ankle",))


@pytest.mark.parametrize(
    ("shape", "half"),
    [
        ("<box><size>0.2 0.4 0.6</size></box>", (0.2, 0.1, 0.3)),  # turned by a quarter: x lies along y
        ("<cylinder><radius>0.1</radius><length>0.5</length></cylinder>", (0.1, 0.1, 0.25)),
        ("<capsule><radius>0.1</radius><length>0.5</length></capsule>", (0.1, 0.1, 0.35)),
        ("<sphere><radius>0.3</radius></sphere>", (0.3, 0.3, 0.3)),
    ],
)
def test_shapes_reach_as_far_as_they_are_large_about_their_pose(
    tmp_path: Path, shape: str, half: tuple[float, ...]
) -> None:
    tree = tree_of(tmp_path, shape)
    collision = tree.links["ankle"].find("collision")
    assert collision is not None
    points = tree.points(collision)
    assert points is not None
    assert (points.max(axis=0) - points.min(axis=0)) / 2 == pytest.approx(half)
    assert (points.max(axis=0) + points.min(axis=0)) / 2 == pytest.approx((1, 2, 3))
    np.testing.assert_allclose(pose_of(collision)[:3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)


def test_meshes_that_a_reader_does_not_take_are_left_out_and_named(tmp_path: Path) -> None:
    path = write_urdf(tmp_path / "biped.urdf")
    shapes = "".join(
        f'<{tag}><geometry><mesh filename="meshes/{name}"/></geometry></{tag}>'
        for tag, name in (("visual", "a.DAE"), ("visual", "b.obj"), ("collision", "c.ply"))
    )
    path.write_text(path.read_text().replace('<link name="pelvis">', f'<link name="pelvis">{shapes}'))
    for taken, kept in (
        (None, ["c.ply", "a.DAE", "b.obj"]),
        ((".obj",), ["b.obj"]),
        ((".dae", ".obj"), ["a.DAE", "b.obj"]),
    ):
        notes = Notes()
        root = sdf_from_urdf(path, notes, taken)
        found = [uri.rsplit("/", 1)[-1] for uri in (element.text or "" for element in root.iter("uri"))]
        assert found == kept
        said = [note.text for note in notes if note.code == "export_mesh"]
        lost = [name for name in ("c.ply", "a.DAE", "b.obj") if name not in kept]
        assert len(said) == bool(lost)
        if lost:
            assert f"{len(lost)} meshes that are not {', '.join(taken or ())} left out: {lost[0]}" in said[0]
