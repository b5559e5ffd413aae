"""How far a motion may go: how near each limit it comes, over a whole range of stiffness, relative to the limit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.contact.polygon import convex_hull
from plantar.conventions import GRAVITY, Array
from plantar.design.family import CHANNELS, Lines
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot
from plantar.design.soft_feet import Response, Softness, respond

RATE: Final = 20.0  # Hz: sixteen samples in the quickest sine
EDGE: Final = 0.010  # m, of the centre of pressure from each sole's border; `identify feet` drops 5 mm
SMALLER_EDGE: Final = 0.3  # of a sole's half width at most: small feet need some room to be excited
LIFT: Final = 0.3  # of its load at rest that every foot keeps at least
BEND: Final = 0.1  # rad of the bush: less than the paper's largest, where rubber may harden
# Of each kind of channel: share of the centre of mass' height, rad, swings. Far enough for the bushes, near enough to
# standing for what is linear here.
LARGEST: Final = {"centre": 0.02, "trunk": 0.08, "arms": 1.0, "left": 0.1, "right": 0.1}
ROOM: Final = 0.8  # of the way to a joint's limit, and of its speed


@dataclass(frozen=True)
class Shares:
    """What one unit of each coefficient does, at one stiffness: arrays (size, N) each.

    `torque`, `rate`, `deflection` (size, 2, N) in pitch and roll, `load` (size, N), by foot.
    """

    softness: Softness
    response: Response


class Reach:
    """Limits of one robot, for motions on `lines`, over bushes from soft to stiff."""

    def __init__(self, legs: Legs, robot: LinearRobot, lines: Lines, range_of: Sequence[Softness]) -> None:
        self.lines, self.time = lines, lines.time(RATE)
        shapes = lines.shapes(self.time)
        count = 2 * shapes.shape[1] // 2
        basis = np.zeros((lines.size, len(CHANNELS), self.time.size))
        for channel in range(len(CHANNELS)):
            basis[channel * count : (channel + 1) * count, channel] = shapes[channel]
        quick = np.gradient(basis, 1 / RATE, axis=-1)
        wrench = robot.wrench(basis, np.gradient(quick, 1 / RATE, axis=-1))[:, [2, 3, 4]]
        tilts = {
            foot: basis[:, [CHANNELS.index(f"{foot}.roll"), CHANNELS.index(f"{foot}.pitch")]]
            for foot in legs.bushes
        }
        self.shares = [
            Shares(bush, respond(robot.pendulum, bush, wrench, tilts, 1 / RATE)) for bush in range_of
        ]
        self.weight = robot.pendulum.mass * GRAVITY / len(tilts)
        height = robot.pendulum.height
        self._largest = np.array(
            [
                LARGEST[kind] * (height if kind == "centre" else 1.0)
                for kind in (c.split(".")[0] for c in CHANNELS)
            ]
        )
        self._edges = {foot: _edges(legs, foot) for foot in tilts}
        self._joints(legs, robot, shapes)

    def _joints(self, legs: Legs, robot: LinearRobot, shapes: Array) -> None:
        """How far each joint may go and how fast, about standing."""
        model, rest = legs.model, legs.rest[0]
        self._moving, room, speed = [], [], []
        for joint in model.joints[2:]:
            if joint.nv != 1 or not np.abs(robot.joints[:, joint.idx_v]).max() > 1e-9:
                continue
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            bounded = joint.nq == 1 and low < high
            self._moving.append(joint.idx_v)
            room.append(
                [ROOM * (rest[joint.idx_q] - low), ROOM * (high - rest[joint.idx_q])]
                if bounded
                else [np.inf] * 2
            )
            fastest = float(model.upperVelocityLimit[joint.idx_v])
            speed.append(ROOM * fastest if 0 < fastest < np.inf else np.inf)
        self._room, self._speed = np.maximum(np.array(room), 1e-6), np.array(speed)
        self._shapes, self._quick = shapes, np.gradient(shapes, 1 / RATE, axis=-1)
        self._gain = robot.joints[:, self._moving]

    def nearest(self, coefficients: Array) -> float:
        """How much of the tightest limit a motion takes up: it may be larger by the inverse of this."""
        return max(
            self._joints_used(coefficients), *(self._feet_used(share, coefficients) for share in self.shares)
        )

    def _joints_used(self, coefficients: Array) -> float:
        table = coefficients.reshape(len(CHANNELS), -1)
        channels = np.einsum("cl,cln->cn", table, self._shapes)
        moved = self._gain.T @ channels
        fast = self._gain.T @ np.einsum("cl,cln->cn", table, self._quick)
        return max(
            float((np.abs(channels).max(axis=1) / self._largest).max()),
            float((-moved.min(axis=1) / self._room[:, 0]).max()),
            float((moved.max(axis=1) / self._room[:, 1]).max()),
            float((np.abs(fast).max(axis=1) / self._speed).max()),
        )

    def _feet_used(self, share: Shares, coefficients: Array) -> float:
        used = 0.0
        for foot, (normals, room) in self._edges.items():
            torque = np.tensordot(coefficients, share.response.torque[foot], 1)
            load = coefficients @ share.response.load[foot]
            bend = np.abs(np.tensordot(coefficients, share.response.deflection[foot], 1)).max()
            # The centre of pressure is (-torque pitch, torque roll)/load from below the bush.
            out = normals[:, :1] * -torque[0] + normals[:, 1:] * torque[1] + room[:, None] * load
            used = max(
                used,
                float((-out.min(axis=1) / (room * self.weight)).max()),
                float(-load.min() / ((1 - LIFT) * self.weight)),
                float(bend / BEND),
            )
        return used


def margin_kept(polygon: Array) -> float:
    """Distance [m] from a sole's border that the centre of pressure keeps."""
    return float(min(EDGE, SMALLER_EDGE * np.ptp(polygon, axis=0).min() / 2))


def _edges(legs: Legs, foot: str) -> tuple[Array, Array]:
    """Inward normals (n, 2) of a sole's edges in the world's axes, and the room (n,) [m] of a centre of pressure
    below the bush to each, less the margin. Raises MotionError where there is none."""
    entry = legs.body.robot.feet[foot]
    sole = legs.start.soles[foot]
    bush = legs.rest[2][foot].translation
    corners = np.array([sole.act(np.array([*corner, 0.0]))[:2] for corner in entry.sole.polygon]) - bush[:2]
    corners = convex_hull(corners)
    along = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    return normals, -np.sum(normals * corners, axis=1) - margin_kept(corners)
