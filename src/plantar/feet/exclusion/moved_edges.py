"""Edges of a sole that seem to lie inside of its outline, since a zero of the torque moves the centre of pressure."""

from __future__ import annotations

import numpy as np

from plantar.contact.polygon import edge_normals
from plantar.conventions import Array
from plantar.feet.recording import Recording
from plantar.signals.segments import steps_in

FEWEST = 0.04  # s beyond an edge, in all: less may be a shock


def moved_inwards(recording: Recording, foot: str, depth: Array, polygon: Array) -> Array:
    """By how much each edge of the convex `polygon` (n, 2) [m] seems to have come inwards, (N, n) [m], at least.

    depth: of the centre of pressure inside each edge, (N, n) [m]. It cannot leave the sole: where it reads outside of
    one edge, the torque is wrong by that distance times the load at least, and an edge on the other side, if it was not
    passed itself, is reached that much earlier.
    """
    load = np.maximum(recording.bushes[foot].force_z, 1.0)
    standing, fewest = recording.contacts[foot].standing, steps_in(FEWEST, recording.period)
    if standing.sum() < fewest:
        return np.zeros_like(depth)
    moments = np.nan_to_num(-depth * load[:, None])[standing]  # beyond each edge's line
    beyond = np.sort(moments, axis=0)[-fewest].clip(min=0.0)
    normals = edge_normals(polygon)
    inwards = ((-normals @ normals.T).clip(min=0.0) * beyond).max(axis=1)
    return np.where(beyond > 0, 0.0, inwards) / load[:, None]
