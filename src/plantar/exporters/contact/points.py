"""Where points under a sole push on the ground, and how hard, so that together they turn like the bush.

Springs k at x and y along a sole hold it with K_pitch = Σ k x² and K_roll = Σ k y², whatever the load, as long as all
of them touch. A point only pushes: once the centre of pressure comes near an edge, the far points leave the ground and
the foot gets softer. That range is widest where the load stands at the edges, on corners; but corners that turn as
softly as rubber let the foot sink by millimetres. So the corners stand a little lower and carry a first part of the
load, and a stiff point under the bush takes the rest. Two more points in front and behind, and at the sides, set the
damping of pitch and roll apart. Where an edge has left the ground, second points go on (`PointFoot.taking_over`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, QhullError

from plantar.conventions import Array, Axis
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.spring import DAMPING_TIME

Pair = tuple[float, float]

# C/K of any point lies within this factor of the foot's own two: a damper pushes only as far as its spring is loaded.
SPREAD: Final = 4.0
# The points may stand this much wider or longer than the sole, where K of roll and pitch do not suit its shape.
WIDEST: Final = 1.5
# Times what the edges are pressed in, flat: turned to where K and C are fitted, 1.25 at most.
NEARLY_FLAT: Final = 1.3
HARD: Final = 0.001  # m: what a foot sinks under the robot's weight where its vertical stiffness is not known


@dataclass(frozen=True)
class Point:
    """A spring and a damper between the sole and the ground, at `x` forward and `y` left of the bush's axis [m].

    `stiffness` [N/m] and `damping` [N·s/m], along the sole's normal; it stands `lower` than the sole's plane [m].
    """

    x: float
    y: float
    stiffness: float
    damping: float
    lower: float = 0.0


@dataclass(frozen=True)
class PointFoot:
    """A foot on points; the sole's plane is `depth` [m] below the bush centre."""

    points: tuple[Point, ...]
    depth: float

    @property
    def vertical(self) -> Pair:
        """Stiffness [N/m] and damping [N·s/m] along z."""
        flat = [p for p in self.points if p.lower >= 0]
        return sum(p.stiffness for p in flat), sum(p.damping for p in flat)

    @property
    def first_load(self) -> float:
        """What the edges carry before the sole's plane is down, flat [N]."""
        return sum(p.stiffness * p.lower for p in self.points if p.lower > 0)

    def turning(self, axis: Axis) -> Pair:
        """Stiffness [N·m/rad] and damping [N·m·s/rad] of pitch or roll about the bush's axis, near flat."""
        pairs = [(arm, p) for arm, p in zip(self._arms(axis), self.points, strict=True) if p.lower >= 0]
        return sum(p.stiffness * arm**2 for arm, p in pairs), sum(p.damping * arm**2 for arm, p in pairs)

    def sink(self, load: float) -> float:
        """How far a load [N] presses the sole below the ground, flat [m]; negative where the edges hold it up."""
        edges = [p for p in self.points if p.lower > 0] or self.points
        first, lower = sum(p.stiffness for p in edges), edges[0].lower
        alone = load / first - lower
        return alone if alone <= 0 else (load - first * lower) / self.vertical[0]

    def touching_angle(self, axis: Axis, load: float) -> float:
        """The angle at which the first edge leaves the ground under a load [N], alone in pitch or roll [rad]."""
        arms = zip(self._arms(axis), self.points, strict=True)
        edges = [(abs(arm), p) for arm, p in arms if arm and p.lower >= 0]
        return min((self.sink(load) + p.lower) / arm for arm, p in edges)

    def taking_over(self, load: float, most: float) -> PointFoot:
        """With a second point at each edge, which touches when the edge across leaves the ground under a load [N].

        It pushes with what that edge held with, so that K and C go on as they were, until the middle leaves the
        ground too and the sole tips. None on a foot without a middle: there the edge that leaves is the tipping. Under
        the largest load that K has to hold at, `most` [N], none touches a foot that is nearly flat.
        """
        edges = [p for p in self.points if p.lower > 0]
        if len(edges) == len(self.points) or not edges:
            return self
        pressed, deepest = (self.sink(one) + edges[0].lower for one in (load, most))
        second = []
        for p in edges:
            arm = float(np.hypot(p.x, p.y))
            opposite = (-np.sign(p.x), -np.sign(p.y))
            across = next(o for o in edges if (np.sign(o.x), np.sign(o.y)) == opposite)
            share = float(np.hypot(across.x, across.y)) / arm
            lower = p.lower - max(pressed * (1 + 1 / share), NEARLY_FLAT * deepest)
            second.append(Point(p.x, p.y, p.stiffness * share, p.damping * share, lower))
        return PointFoot((*self.points, *second), self.depth)

    def _arms(self, axis: Axis) -> list[float]:
        return [p.x if axis == "pitch" else p.y for p in self.points]


@dataclass(frozen=True)
class Sides:
    """A rectangle about the bush's axis: its edges' distances to the front, back, left and right [m]."""

    front: float
    back: float
    left: float
    right: float

    def square(self, axis: Axis) -> float:
        """K of pitch or roll per vertical stiffness of points at the edges [m²]."""
        return self.front * self.back if axis == "pitch" else self.left * self.right

    def scaled(self, length: float, width: float) -> Sides:
        return Sides(self.front * length, self.back * length, self.left * width, self.right * width)


def sides_of(foot: FootBush) -> Sides:
    """The sole as a rectangle along the bush's axes: its outline's extent, shrunk to the outline's area.

    Raises ExportError where the sole has no area or the bush does not stand over it.
    """
    outline = ((foot.sole - foot.centre) @ foot.rotation)[:, :2]
    try:
        area = float(ConvexHull(outline).volume)  # of a plane figure, its area
    except (QhullError, ValueError) as error:
        raise ExportError(f"the sole of '{foot.name}' has no area") from error
    low, high = outline.min(axis=0), outline.max(axis=0)
    if low.max() >= 0 or high.min() <= 0:
        message = f"the bush of '{foot.name}' does not stand over its sole"
        raise ExportError(message, valid="a bush between the sole's edges")
    share = float(np.sqrt(area / np.prod(high - low)))
    return Sides(*(share * float(side) for side in (high[0], -low[0], high[1], -low[1])))


def points_for(
    stiffness: Mapping[Axis, float],
    damping: Mapping[Axis, float],
    sole: Sides,
    depth: float,
    weight: float,
    edges: float,
) -> PointFoot:
    """Points that turn with these K and C about the bush's axis, and give along z what the edges leave to the middle.

    Where only pitch or only roll is given, corners alone carry at the edges, and the other comes as it comes.

    Args:
        stiffness, damping: of pitch, roll [N·m/rad, N·m·s/rad] and, if known, z [N/m, N·s/m].
        sole: the rectangle to stand on.
        depth: of the sole's plane below the bush centre [m].
        weight: of the robot [N].
        edges: of the weight, what the edges carry before the middle touches. Less lets them leave the ground at smaller
            angles, more leaves a foot that carries less than this without its vertical stiffness.
    """
    axes: list[Axis] = [axis for axis in ("pitch", "roll") if axis in stiffness]
    sole = _suited(sole, stiffness) if len(axes) == 2 else sole
    squares = np.array([sole.square(axis) for axis in axes])
    k = np.array([stiffness[axis] for axis in axes]) / squares
    c = np.array([damping[axis] for axis in axes]) / squares
    if len(axes) == 2:
        first, damper = _shares(k, c)
    else:
        first, damper = np.array([k[0], 0.0, 0.0]), np.array([c[0], 0.0, 0.0])
    total = float(first.sum())
    rest = stiffness.get("z", weight / HARD) - total
    if rest <= 0:
        return PointFoot(tuple(_placed(sole, first, damper, 0.0)), depth)
    points = _placed(sole, first, damper, edges * weight / total)
    softest = min(p.damping / p.stiffness for p in points)
    middle = max(damping.get("z", 0.0) - float(damper.sum()), min(DAMPING_TIME, softest) * rest)
    return PointFoot((*points, Point(0.0, 0.0, rest, middle)), depth)


def _suited(sole: Sides, stiffness: Mapping[Axis, float]) -> Sides:
    """The rectangle made wider or longer until its corners alone hold both K, as far as `WIDEST` allows."""
    ratio = np.sqrt(stiffness["roll"] / sole.square("roll") / stiffness["pitch"] * sole.square("pitch"))
    return sole.scaled(min(max(1 / ratio, 1.0), WIDEST), min(max(float(ratio), 1.0), WIDEST))


def _shares(k: Array, c: Array) -> tuple[Array, Array]:
    """Vertical stiffness and damping of the corners, of front and back, and of left and right, (3,) each.

    A linear programme: corners, front and back make pitch, corners and sides make roll; the smallest sum of stiffness
    leaves most of the load to the corners. It always has an answer: without corners each axis has its own two points.
    """
    unit_k, unit_c = float(k.max()), float(c.max()) or 1.0
    held = np.array([[1.0, 1.0, 0.0], [1.0, 0.0, 1.0]])
    equal = np.block([[held, np.zeros((2, 3))], [np.zeros((2, 3)), held]])
    times = (c / unit_c) / (k / unit_k)
    slow, fast = SPREAD * float(times.max()), float(times.min()) / SPREAD
    bounds = np.block([[-slow * np.eye(3), np.eye(3)], [fast * np.eye(3), -np.eye(3)]])
    wanted = np.concatenate([k / unit_k, c / unit_c])
    found = linprog([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], bounds, np.zeros(6), equal, wanted).x
    found[np.tile(found[:3] < 1e-6, 2)] = 0.0
    return found[:3] * unit_k, found[3:] * unit_c


def _placed(sole: Sides, k: Array, c: Array, lower: float) -> list[Point]:
    """The points of each group that has stiffness, the near edge loaded more: all pushes balance about the bush."""
    ahead = sole.back / (sole.front + sole.back)
    aside = sole.right / (sole.left + sole.right)
    x, y = ((sole.front, ahead), (-sole.back, 1 - ahead)), ((sole.left, aside), (-sole.right, 1 - aside))
    groups = (
        [(px, py, wx * wy) for px, wx in x for py, wy in y],
        [(px, 0.0, wx) for px, wx in x],
        [(0.0, py, wy) for py, wy in y],
    )
    return [
        Point(px, py, float(share * one), float(share * other), lower)
        for group, one, other in zip(groups, k, c, strict=True)
        for px, py, share in group
        if one > 0
    ]
