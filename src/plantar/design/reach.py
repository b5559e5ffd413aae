"""How far a motion may go: how near each limit it comes, over a whole range of stiffness, relative to the limit."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from copy import copy
from typing import Final

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.design.family import CHANNELS, Lines
from plantar.design.legs import Legs
from plantar.design.linear import LinearRobot, internal_forces
from plantar.design.rubber import SECANT, SHARE, remembered
from plantar.design.soft_feet import Softness, respond
from plantar.design.soles import edges, ends, outward
from plantar.feet.fit.hidden_memory import SLIPS
from plantar.motions.upper import ROOM
from plantar.twin.presets import DEFAULT, preset_named

RATE: Final = 20.0  # Hz: eight samples in the quickest sine
FINER: Final = 2  # times: of what is differentiated
# Hz, of what stiffness and damping show in: eight samples in the quickest sine of an ankle
FIRM_RATE: Final = 10.0
FRICTION: Final = 0.3  # of horizontal to vertical force at most: dry rubber on any floor holds more
SIDES: Final = 8  # of the polygon that stands for the circle of friction
LIFT: Final = 0.35  # of its load at rest that every foot keeps at least
BEND: Final = 0.1  # rad of the bush: less than the paper's largest, where rubber may harden
# Of each channel: share of the centre of mass' height, rad, swings. Far enough for the bushes, near enough to standing
# for what is linear here.
LARGEST: Final = {
    "centre.x": 0.07, "centre.y": 0.1, "centre.z": 0.02, "trunk.roll": 0.08, "trunk.pitch": 0.08, "arms": 1.0,
    "left.roll": 0.1, "left.pitch": 0.1, "right.roll": 0.1, "right.pitch": 0.1,
}  # fmt: skip
_SIDES: Final = np.column_stack([trig(2 * np.pi * np.arange(SIDES) / SIDES) for trig in (np.cos, np.sin)])
STILL: Final = 1e-9  # of a channel's limit: that one stays at rest
# Of what each bush is limited by: centres of pressure at the ends and at the sides of soles, friction, load, bend.
KINDS: Final = ("ends", "sides", "friction", "load", "bend")
NEAR: Final = 0.8  # of a limit: what a step of the search watches from the start


class Reach:
    """Limits of one robot, for motions on `lines`, over bushes from soft to stiff.

    What one unit of each coefficient does: `deflection` [rad] and `rate` [rad/s] (size, S, feet, 2, N) in pitch and
    roll, `load` (size, S, feet, N) [N], for S bushes; `firm_deflection` and `firm_rate`, at `firm_time` (M,) [s],
    where rubber that slips stands beside the springs; what it asks of the ground, `forces` (size, 3, N) [N] and
    `wrench_rates` (size, 3, N), of the vertical force [N/s] and of the moments about x and y [N·m/s].
    Limits hold for the plain springs, with what slips added to their torques; intervals come from the others.
    `element`: stiffness (2,) of what slips beside pitch and roll, where that is known [N·m/rad].
    """

    def __init__(
        self,
        legs: Legs,
        robot: LinearRobot,
        lines: Lines,
        told: Softness,
        bushes: Sequence[Softness],
        element: Array | None,
    ) -> None:
        self.lines, self.time = lines, lines.time(RATE)
        self.bushes, self.feet = tuple(bushes), tuple(legs.bushes)
        fine, period = lines.basis(lines.time(FINER * RATE)), 1 / (FINER * RATE)
        quick = np.gradient(fine, period, axis=-1)
        asked = robot.wrench(fine, np.gradient(quick, period, axis=-1))
        changed = np.gradient(asked[:, 2:5], period, axis=-1)
        self._basis, self._quick, wrench, self.wrench_rates = (
            np.ascontiguousarray(one[..., ::FINER]) for one in (fine, quick, asked, changed)
        )
        tilts = {
            foot: self._basis[:, [CHANNELS.index(f"{foot}.roll"), CHANNELS.index(f"{foot}.pitch")]]
            for foot in self.feet
        }
        # Of what slips beside every spring, by axis: at least the rubber of the rehearsals, which goes with the weight.
        rubber = np.array(preset_named(DEFAULT).slip_torques(legs.body.robot)) / SLIPS
        self.element = np.maximum(told.stiffness * np.array(SHARE) if element is None else element, rubber)

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
        firm = slice(None, None, round(RATE / FIRM_RATE))
        self.firm_time = self.time[firm]
        self.firm_deflection, self.firm_rate = (
            np.ascontiguousarray(part[..., firm])
            for part in parts(SECANT * self.element, "deflection", "rate")
        )
        self.stiffness = np.array([bush.stiffness for bush in bushes])
        self.damping = np.array([bush.damping for bush in bushes])
        self.forces = wrench[:, :3]
        self.vertical = told.vertical
        self.weight = robot.pendulum.mass * GRAVITY / len(self.feet)
        self._edges = [edges(legs, foot) for foot in self.feet]
        self._squeezed = internal_forces(legs)
        height = robot.pendulum.height
        scales = (height if channel.startswith("centre") else 1.0 for channel in CHANNELS)
        largest = [LARGEST[channel] * scale for channel, scale in zip(CHANNELS, scales, strict=True)]
        bent = self.deflection.reshape(lines.size, -1, self.time.size)
        load = self.load.reshape(lines.size, -1, self.time.size)
        own = [(self._basis, np.array(largest), np.array(largest)), *self._joints(legs, robot)]
        over_bushes = [
            (bent, *2 * (np.full(bent.shape[1], BEND),)),
            (load, np.full(load.shape[1], (1 - LIFT) * self.weight), np.full(load.shape[1], np.inf)),
            *(self._sole(place) for place in range(len(self.feet))),
            *(self._floor(place) for place in range(len(self.feet))),
        ]
        towards = [(~ends(normals)).astype(int) for normals, _ in self._edges]
        kinds = [np.full(1, KINDS.index("bend")), np.full(1, KINDS.index("load")), *towards]
        kinds += len(self.feet) * [np.full(1, KINDS.index("friction"))]
        # What is watched, (size, series, N), how far each series may go down and up, (series,), and of which bush
        # and kind it is, behind all of these where over no bush.
        limits = [*own, *over_bushes]
        self._watched = np.concatenate([values for values, _, _ in limits], axis=1)
        self._low, self._high = (np.concatenate([one[side] for one in limits]) for side in (1, 2))
        first = len(KINDS) * np.arange(len(self.bushes))[:, None]
        groups = [
            (first + np.resize(kind, low.size // len(first))).ravel()
            for kind, (_, low, _) in zip(kinds, over_bushes, strict=True)
        ]
        others = np.full(sum(low.size for _, low, _ in own), first.size * len(KINDS))
        self._group = np.concatenate([others, *groups])
        # Of each series, its place in what slips; -1 where nothing does: edges and friction come last.
        slipping = sum(low.size for _, low, _ in over_bushes[2:])
        self._slips = np.maximum(np.arange(self._low.size) - (self._low.size - slipping), -1)

    def held(self, shares: Array, others: float = 1.0, still: Collection[str] = ()) -> Reach:
        """The same with limits of which motions may use `shares` (S, KINDS), of those over no bush `others`. Channels
        that are to stay `still` have none left."""
        found, scale = copy(self), np.append(shares, others)[self._group]
        scale[[CHANNELS.index(channel) for channel in still]] = STILL
        found._low, found._high = scale * self._low, scale * self._high
        return found

    def used_by_kind(self, coefficients: Array) -> Array:
        """How much of its tightest limit of each kind over each bush a motion takes up, (S, KINDS)."""
        return self._used_by_group(coefficients)[:-1].reshape(-1, len(KINDS))

    def used_over_none(self, coefficients: Array) -> float:
        """How much of the tightest limit over no bush, of channels and joints, a motion takes up."""
        return float(self._used_by_group(coefficients)[-1])

    def _used_by_group(self, coefficients: Array) -> Array:
        found = np.zeros(len(self.bushes) * len(KINDS) + 1)
        for side in self._shares(coefficients):
            np.maximum.at(found, self._group, side.max(axis=1))
        return found

    def _joints(self, legs: Legs, robot: LinearRobot) -> list[tuple[Array, Array, Array]]:
        """How far each joint goes and how fast, about standing, and how far and fast it may."""
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
        down, up = np.maximum(ROOM * np.array(room), 1e-6).T
        gain, fast = robot.joints[:, moving].T, ROOM * np.array(speed)
        return [(gain @ self._basis, down, up), (gain @ self._quick, fast, fast)]

    def _sole(self, place: int) -> tuple[Array, Array, Array]:
        """Towards each edge of a foot's sole, its springs' torque less what its load holds [N·m], and its limits."""
        normals, room = self._edges[place]
        out = outward(normals, self._torque()[:, :, place]) - room[:, None] * self.load[:, :, place, None]
        high = np.tile(room * self.weight, len(self.bushes))
        return out.reshape(self.lines.size, high.size, -1), np.full(high.size, np.inf), high

    def _floor(self, place: int) -> tuple[Array, Array, Array]:
        """Towards each side, a foot's horizontal force less what friction holds under its load [N], and its limits."""
        aside = (
            self._aside(place, self._torque(), self.load)
            + 0.5 * np.einsum("ek,ckn->cen", _SIDES, self.forces[:, :2])[:, None]
        )
        out = aside - FRICTION * self.load[:, :, place, None]
        high = np.full(len(self.bushes) * SIDES, FRICTION * self.weight)
        return out.reshape(self.lines.size, high.size, -1), np.full(high.size, np.inf), high

    def _torque(self) -> Array:
        """Of the springs and dampers, per unit of each coefficient, (size, S, feet, 2, N) [N·m]."""
        return np.asarray(
            self.stiffness[:, None, None, None] * self.deflection
            + self.damping[:, None, None, None] * self.rate
        )

    def _aside(self, place: int, torque: Array, load: Array | None = None) -> Array:
        """Towards each side, what one foot pushes against the other, (..., SIDES, N) [N], of torques
        (..., feet, 2, N) and loads (..., feet, N)."""
        other = torque.shape[-3] - 1 - place
        odd = (torque[..., place, :, :] - torque[..., other, :, :]) / 2
        pushed = np.einsum("ek,kj,...jn->...en", _SIDES, self._squeezed[:, :2], odd)
        if load is not None:
            less = (load[..., place, :] - load[..., other, :]) / 2
            pushed += np.einsum("ek,k,...n->...en", _SIDES, self._squeezed[:, 2], less)
        return np.asarray(pushed)

    def of(self, part: Array, coefficients: Array) -> Array:
        """A part (size, ...) of the response of motions with coefficients (..., size)."""
        found = coefficients @ part.reshape(self.lines.size, -1)
        return np.asarray(found.reshape(*coefficients.shape[:-1], *part.shape[1:]))

    def used(self, coefficients: Array) -> float:
        """How much of the tightest limit a motion takes up: it may be larger by the inverse of this."""
        return float(max(side.max() for side in self._shares(coefficients)))

    def alone(self) -> Array:
        """What one unit of each coefficient alone uses of the limits, (size,)."""
        each = zip(self._watched, self.deflection, strict=True)
        return np.array([max(side.max() for side in self._shares_of(*one)) for one in each])

    def close(self, coefficients: Array, above: float) -> Reach:
        """The same with those limits alone of which a motion takes up more than a share: few of them, and quick."""
        found = copy(self)
        shares = np.max([side.max(axis=1) for side in self._shares(coefficients)], axis=0)
        series = np.flatnonzero(shares > above)
        found._watched = np.ascontiguousarray(self._watched[:, series])
        found._low, found._high, found._group, found._slips = (
            one[series] for one in (self._low, self._high, self._group, self._slips)
        )
        return found

    def near(self, coefficients: Array, above: float = NEAR) -> tuple[Array, Array]:
        """Where a motion takes up more than a share of a limit, for every series its worst time: how that share goes
        with the coefficients, (m, size), and what is left of it, (m,)."""
        rows, left = [], []
        for share, limit in zip(self._shares(coefficients), (-self._low, self._high), strict=True):
            worst = share.argmax(axis=1)
            largest = share[np.arange(len(share)), worst]
            series = np.flatnonzero(largest > above)
            rows.append((self._watched[:, series, worst[series]] / limit[series]).T)
            left.append(1.0 - largest[series])
        return np.vstack(rows), np.concatenate(left)

    def _shares(self, coefficients: Array) -> tuple[Array, Array]:
        """Of its limits downwards and upwards, what every series (series, N) takes up."""
        return self._shares_of(self.of(self._watched, coefficients), self.of(self.deflection, coefficients))

    def _shares_of(self, watched: Array, bent: Array) -> tuple[Array, Array]:
        """The same of what plain springs make of every series (series, N) and of the bends (S, feet, 2, N)."""
        slip = self._slips >= 0
        watched = watched.copy()
        watched[slip] += self._slipping(bent)[self._slips[slip]]
        return -watched / self._low[:, None], watched / self._high[:, None]

    def _slipping(self, bent: Array) -> Array:
        """What the elements beside the springs add to the series of the soles' edges and of friction, (series, N)."""
        states = remembered(bent.reshape(-1, bent.shape[-1]), [SLIPS]).reshape(bent.shape)
        torque = self.element[:, None] * states
        edges = [outward(normals, torque[:, place]) for place, (normals, _) in enumerate(self._edges)]
        sides = [self._aside(place, torque) for place in range(len(self.feet))]
        return np.concatenate([one.reshape(-1, bent.shape[-1]) for one in (*edges, *sides)])
