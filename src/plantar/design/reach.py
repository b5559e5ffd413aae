"""How far a motion may go: how near each limit it comes, over a whole range of stiffness, relative to the limit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plantar.contact.polygon import convex_hull
from plantar.conventions import GRAVITY, Array
from plantar.design.family import CHANNELS, Lines
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot
from plantar.design.rubber import SECANT, SHARE, SLIP_ANGLE, remembered
from plantar.design.soft_feet import Softness, respond
from plantar.twin.presets import DEFAULT, preset_named

RATE: Final = 20.0  # Hz: sixteen samples in the quickest sine
EDGE: Final = 0.007  # m, of the centre of pressure from each sole's border; `identify feet` drops 5 mm
SMALLER_EDGE: Final = 0.2  # of a sole's half width at most: small feet need some room to be excited
LIFT: Final = 0.35  # of its load at rest that every foot keeps at least
BEND: Final = 0.1  # rad of the bush: less than the paper's largest, where rubber may harden
# Of each channel: share of the centre of mass' height, rad, swings. Far enough for the bushes, near enough to standing
# for what is linear here.
LARGEST: Final = {
    "centre.x": 0.07, "centre.y": 0.1, "centre.z": 0.02, "trunk.roll": 0.08, "trunk.pitch": 0.08, "arms": 1.0,
    "left.roll": 0.1, "left.pitch": 0.1, "right.roll": 0.1, "right.pitch": 0.1,
}  # fmt: skip
ROOM: Final = 0.8  # of the way to a joint's limit, and of its speed


class Reach:
    """Limits of one robot, for motions on `lines`, over bushes from soft to stiff.

    What one unit of each coefficient does: `deflection` [rad] and `rate` [rad/s] (size, S, feet, 2, N) in pitch and
    roll, `load` (size, S, feet, N) [N], for S bushes; `firm_deflection` and `firm_rate` where rubber that slips stands
    beside the springs; what it asks of the ground, `forces` (size, 3, N) [N] and `moment_rates` (size, 2, N) of the
    moments about x and y [N·m/s].
    Limits hold for the plain springs, which bend more, intervals come from the others.
    """

    def __init__(
        self, legs: Legs, robot: LinearRobot, lines: Lines, told: Softness, bushes: Sequence[Softness]
    ) -> None:
        self.lines, self.time, self.bushes, self.feet = (
            lines,
            lines.time(RATE),
            tuple(bushes),
            tuple(legs.bushes),
        )
        self._basis = lines.basis(self.time)
        self._quick = np.gradient(self._basis, 1 / RATE, axis=-1)
        wrench = robot.wrench(self._basis, np.gradient(self._quick, 1 / RATE, axis=-1))
        tilts = {
            foot: self._basis[:, [CHANNELS.index(f"{foot}.roll"), CHANNELS.index(f"{foot}.pitch")]]
            for foot in self.feet
        }
        # Of what slips beside every spring, by axis: at least the rubber of the rehearsals, which goes with the weight.
        rubber = np.array(preset_named(DEFAULT).slip_torques(legs.body.robot)) / SLIP_ANGLE
        self.element = np.maximum(told.stiffness * np.array(SHARE), rubber)

        def parts(beside: Array, *names: str) -> list[Array]:
            pitch, roll = (float(value) for value in beside)
            found = [
                respond(robot.pendulum, bush, wrench[:, [2, 3, 4]], tilts, 1 / RATE, (pitch, roll))
                for bush in bushes
            ]
            return [
                np.stack(
                    [np.stack([getattr(one, name)[foot] for foot in self.feet], axis=1) for one in found],
                    axis=1,
                )
                for name in names
            ]

        self.deflection, self.rate, self.load = parts(0 * self.element, "deflection", "rate", "load")
        self.firm_deflection, self.firm_rate = parts(SECANT * self.element, "deflection", "rate")
        self.stiffness = np.array([bush.stiffness for bush in bushes])
        self.damping = np.array([bush.damping for bush in bushes])
        self.forces, self.moment_rates = wrench[:, :3], np.gradient(wrench[:, 3:5], 1 / RATE, axis=-1)
        self.vertical = told.vertical
        self.weight = robot.pendulum.mass * GRAVITY / len(self.feet)
        self._edges = [_edges(legs, foot) for foot in self.feet]
        height = robot.pendulum.height
        self._largest = np.array(
            [LARGEST[channel] * (height if channel.startswith("centre") else 1.0) for channel in CHANNELS]
        )
        self._joints(legs, robot)

    def _joints(self, legs: Legs, robot: LinearRobot) -> None:
        """How far each joint may go and how fast, about standing."""
        model, rest = legs.model, legs.rest[0]
        moving, room, speed = [], [], []
        for joint in model.joints[2:]:
            if joint.nv != 1 or not np.abs(robot.joints[:, joint.idx_v]).max() > 1e-9:
                continue
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            bounded = joint.nq == 1 and low < high
            moving.append(joint.idx_v)
            room.append([rest[joint.idx_q] - low, high - rest[joint.idx_q]] if bounded else [np.inf, np.inf])
            fastest = float(model.upperVelocityLimit[joint.idx_v])
            speed.append(fastest if 0 < fastest < np.inf else np.inf)
        self._room = np.maximum(ROOM * np.array(room), 1e-6)
        self._speed = ROOM * np.array(speed)
        self._gain = robot.joints[:, moving]

    def of(self, part: Array, coefficients: Array) -> Array:
        """A part (size, ...) of a motion's response."""
        return np.asarray((coefficients @ part.reshape(coefficients.size, -1)).reshape(part.shape[1:]))

    def used(self, coefficients: Array) -> float:
        """How much of the tightest limit a motion takes up: it may be larger by the inverse of this."""
        return max(self._joints_used(coefficients), self._feet_used(coefficients))

    def _joints_used(self, coefficients: Array) -> float:
        channels, quick = self.of(self._basis, coefficients), self.of(self._quick, coefficients)
        moved, fast = self._gain.T @ channels, self._gain.T @ quick
        return max(
            float((np.abs(channels).max(axis=1) / self._largest).max()),
            float((-moved.min(axis=1) / self._room[:, 0]).max()),
            float((moved.max(axis=1) / self._room[:, 1]).max()),
            float((np.abs(fast).max(axis=1) / self._speed).max()),
        )

    def _feet_used(self, coefficients: Array) -> float:
        bent, load = self.of(self.deflection, coefficients), self.of(self.load, coefficients)
        rate = self.of(self.rate, coefficients)
        element = remembered(bent.reshape(-1, bent.shape[-1]), [SLIP_ANGLE]).reshape(bent.shape)
        torque = self.stiffness[:, None, None, None] * bent + self.damping[:, None, None, None] * rate
        torque += self.element[:, None] * element
        used = max(float(np.abs(bent).max()) / BEND, -float(load.min()) / ((1 - LIFT) * self.weight))
        for place, (normals, room) in enumerate(self._edges):
            # The centre of pressure is (-torque pitch, torque roll)/load from below the bush.
            out = np.einsum("ek,skn->sen", normals, torque[:, place] * [[-1.0], [1.0]])
            out += room[:, None] * load[:, place, None]
            used = max(used, float((-out.min(axis=(0, 2)) / (room * self.weight)).max()))
        return used


def margin_kept(polygon: Array) -> float:
    """Distance [m] from a sole's border that the centre of pressure keeps."""
    return float(min(EDGE, SMALLER_EDGE * np.ptp(polygon, axis=0).min() / 2))


def _edges(legs: Legs, foot: str) -> tuple[Array, Array]:
    """Inward normals (n, 2) of a sole's edges in the world's axes, and the room (n,) [m] of a centre of pressure
    below the bush to each, less the margin."""
    entry = legs.body.robot.feet[foot]
    sole = legs.start.soles[foot]
    bush = legs.rest[2][foot].translation
    corners = np.array([sole.act(np.array([*corner, 0.0]))[:2] for corner in entry.sole.polygon]) - bush[:2]
    corners = convex_hull(corners)
    along = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    return normals, -np.sum(normals * corners, axis=1) - margin_kept(corners)
