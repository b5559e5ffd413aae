"""A URDF as a tree: where links are fixed, how far shapes reach, and which files meshes are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from plantar.errors import ExportError
from plantar.exporters.urdf.tree import UrdfTree, origin_of, set_origin

URDF = """
<robot name="arm">
  <link name="base"/>
  <link name="plate">
    <collision><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><geometry>{shape}</geometry></collision>
  </link>
  <link name="cell"/><link name="turning"/>
  <joint name="a" type="fixed"><parent link="base"/><child link="plate"/><origin xyz="1 2 3" rpy="0.3 -0.2 1"/></joint>
  <joint name="b" type="fixed"><parent link="plate"/><child link="cell"/><origin xyz="0 -0.5 0" rpy="0 0.4 0"/></joint>
  <joint name="c" type="continuous"><parent link="cell"/><child link="turning"/><axis xyz="0 0 1"/></joint>
</robot>
"""


def tree_of(folder: Path, shape: str = '<box size="1 1 1"/>') -> UrdfTree:
    path = folder / "arm.urdf"
    path.write_text(URDF.format(shape=shape))
    return UrdfTree.load(path)


def test_a_fixed_link_is_where_pinocchio_has_it_from_either_end(tmp_path: Path) -> None:
    tree = tree_of(tmp_path)
    model = pin.buildModelFromUrdf(str(tmp_path / "arm.urdf"))
    place = {name: model.frames[model.getFrameId(name)].placement for name in ("base", "plate", "cell")}
    for start, goal in (("base", "cell"), ("cell", "base"), ("plate", "cell"), ("plate", "plate")):
        expected = (place[start].inverse() * place[goal]).homogeneous
        np.testing.assert_allclose(tree.fixed_pose(start, goal), expected, atol=1e-12)
    with pytest.raises(
        ExportError,
        match=r"arm\.urdf: link 'turning' is not rigidly fixed to 'base' \(valid: a link without a "
        r"joint in between\)$",
    ):
        tree.fixed_pose("base", "turning")


@pytest.mark.parametrize(
    ("shape", "half"),
    [
        ('<box size="0.2 0.4 0.6"/>', (0.2, 0.1, 0.3)),  # turned by a quarter: x lies along y
        ('<cylinder radius="0.1" length="0.5"/>', (0.1, 0.1, 0.25)),
        ('<capsule radius="0.1" length="0.5"/>', (0.1, 0.1, 0.35)),
        ('<sphere radius="0.3"/>', (0.3, 0.3, 0.3)),
    ],
)
def test_shapes_reach_as_far_as_they_are_large_about_their_origin(
    tmp_path: Path, shape: str, half: tuple[float, ...]
) -> None:
    tree = tree_of(tmp_path, shape)
    points = tree.points(tree.links["plate"].find("collision"))
    assert points is not None
    assert (points.max(axis=0) - points.min(axis=0)) / 2 == pytest.approx(half)
    assert (points.max(axis=0) + points.min(axis=0)) / 2 == pytest.approx((1, 2, 3))


@pytest.mark.parametrize("place", ["arm_description/meshes/foot.stl", "meshes/foot.stl"])
def test_a_mesh_of_a_package_lies_in_its_folder_or_beside_the_file(tmp_path: Path, place: str) -> None:
    """Packages lie beside each other, or the URDF was copied together with its meshes."""
    robots = tmp_path / "robots"
    robots.mkdir()
    tree = tree_of(robots)
    assert tree.mesh_file("package://arm_description/meshes/foot.stl") is None
    mesh = tmp_path / place
    mesh.parent.mkdir(parents=True)
    mesh.touch()
    assert tree.mesh_file("package://arm_description/meshes/foot.stl") == mesh
    assert tree.mesh_file(f"file://{mesh}") == mesh
    assert tree.mesh_file("foot.stl") is None


def test_an_origin_is_read_back_as_it_was_set(tmp_path: Path) -> None:
    tree = tree_of(tmp_path)
    place = tree.fixed_pose("base", "cell")
    for element in (tree.joints["c"], tree.joints["a"]):
        set_origin(element, place)
        np.testing.assert_allclose(origin_of(element), place, atol=1e-9)
    assert len(tree.joints["c"].findall("origin")) == 1


CORNERS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


def stl() -> str:
    faces = [[CORNERS[k] for k in face] for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))]
    corners = "".join(
        "facet normal 0 0 1\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in face)
        + "endloop\nendfacet\n"
        for face in faces
    )
    return f"solid tip\n{corners}endsolid tip\n"


def test_a_mesh_reaches_as_far_as_its_scale_says(tmp_path: Path) -> None:
    """Turned by a right angle about z and moved to (1, 2, 3), as its collision is."""
    (tmp_path / "tip.stl").write_text(stl())
    tree = tree_of(tmp_path, '<mesh filename="tip.stl" scale="0.5 2 3"/>')
    points = tree.points(tree.links["plate"].find("collision"))  # type: ignore[arg-type]
    assert points is not None
    scaled = np.array(CORNERS) * [0.5, 2.0, 3.0]
    wanted = np.column_stack([1 - scaled[:, 1], 2 + scaled[:, 0], 3 + scaled[:, 2]])
    found = np.unique(np.round(points, 6), axis=0)
    np.testing.assert_allclose(found, wanted[np.lexsort(wanted.T[::-1])], atol=1e-6)
    gone = tree_of(tmp_path, '<mesh filename="gone.stl"/>')
    assert gone.points(gone.links["plate"].find("collision")) is None  # type: ignore[arg-type]
