"""Which collision shapes stand on the ground: those that go to the sole when a bush is inserted."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence

import numpy as np

from plantar.conventions import Array
from plantar.exporters.bush import FootBush
from plantar.exporters.comment import mesh_note
from plantar.notes import Notes

SOLE_MASS = 0.05  # kg: light beside any foot, heavy enough for every engine
SOLE_INERTIA = 1e-4  # kg·m² about each axis; shifts the decay rate of K = 500, C = 20 by 0.01 %
PLATE = 0.01  # m: thickness of the plate written where a model has no sole of its own


def reaches_sole(points: Array, foot: FootBush) -> bool:
    """Whether a shape with these points (n, 3) in the ankle's frame reaches past half way from bush to sole,
    or to 5 mm above the sole where the bush itself is that low.

    Such a shape would carry the ground's force past the bush if it stayed with the ankle.
    """
    depths = (foot.centre - np.atleast_2d(points)) @ foot.rotation[:, 2]
    return float(depths.max()) > foot.sole_depth - max(0.5 * foot.sole_depth, 0.005)


def taken_off(
    link: ET.Element,
    place: Array,
    points: Callable[[ET.Element], Array | None],
    foot: FootBush,
    notes: Notes,
    tags: Sequence[str] = ("collision", "visual"),
) -> list[tuple[str, ET.Element]]:
    """A link's shapes that reach the sole, taken off it, each with what it is called.

    link: the ankle, or one that is fixed to it at `place` (4, 4). points: a shape's (n, 3) in the link's frame. A
    collision mesh that cannot be read goes with the sole, with a note.
    """
    taken = []
    for tag in tags:
        for index, shape in enumerate(link.findall(tag)):
            corners = points(shape)
            if corners is None and tag == "collision":
                notes.append(mesh_note(foot))
            elif corners is None or not reaches_sole(corners @ place[:3, :3].T + place[:3, 3], foot):
                continue
            link.remove(shape)
            taken.append((f"{tag} {shape.get('name', index)}", shape))
    return taken


def plate(foot: FootBush) -> tuple[Array, Array]:
    """Full edge lengths (3,) and centre (3,), in the bush's frame, of a plate under the sole's outline."""
    corners = (foot.sole - foot.centre) @ foot.rotation
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = np.array([high[0] - low[0], high[1] - low[1], PLATE])
    return size, np.array([*((low + high) / 2)[:2], -foot.sole_depth + PLATE / 2])
