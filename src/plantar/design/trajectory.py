"""Every joint over time, at the rate of a controller, and as a plan that a simulation can play."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.design.family import Lines
from plantar.design.legs import Legs
from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import Plan
from plantar.motions.stance import Stance
from plantar.motions.track import base_poses, splined
from plantar.motions.walk import KNOTS


@dataclass(frozen=True)
class Trajectory:
    """Configurations (K, nq) of a robot at `knots` (K,) [s]; between them go splines."""

    name: str
    legs: Legs
    knots: Array
    configurations: Array

    @classmethod
    def of(cls, name: str, legs: Legs, lines: Lines, coefficients: Array) -> Trajectory:
        """The motion with these coefficients. Raises MotionError where the legs cannot follow."""
        knots = lines.time(KNOTS)
        return cls(name, legs, knots, legs.follow(lines.displacements(coefficients, knots)))

    def _splines(self) -> CubicSpline:
        positions = np.array([self.legs.body.positions(q) for q in self.configurations])
        return CubicSpline(self.knots, np.unwrap(positions, axis=0), bc_type="clamped")

    def log(self, rate: float) -> MotionLog:
        """Positions of every joint of the URDF, `rate` [Hz]."""
        time = self.time(rate)
        values = self._splines()(time)
        columns = {
            f"joint.{name}.position": np.ascontiguousarray(values[:, place])
            for place, name in enumerate(self.legs.body.joints)
        }
        return MotionLog(self.name, time, columns)

    def time(self, rate: float) -> Array:
        """Times (N,) [s] from 0 to the end, `rate` [Hz]."""
        return np.arange(round(self.knots[-1] * rate) + 1) / rate

    def base(self, rate: float) -> Array:
        """Poses of the floating base, (N, 4, 4), as if the feet were rigid."""
        return base_poses(self.knots, self.configurations, self.time(rate))

    def plan(self) -> Plan:
        """The same on rigid feet, for a simulation."""
        start = self.legs.start
        return splined(
            self.legs.body,
            self.name,
            Stance(self.configurations[0], start.soles, start.standing),
            self.knots,
            self.configurations,
        )

    def limits_used(self) -> tuple[float, float]:
        """How much of the way to a joint's limit, and of its speed, the motion takes up at most."""
        splines, model = self._splines(), self.legs.model
        positions, speeds = splines(self.knots), np.abs(splines(self.knots, 1)).max(axis=0)
        way = fast = 0.0
        for place, name in enumerate(self.legs.body.joints):
            joint = model.joints[model.getJointId(name)]
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            moved = positions[:, place] - positions[0, place]
            if joint.nq == 1 and low < high and np.abs(moved).max() > 1e-9:
                start = positions[0, place]
                way = max(way, -moved.min() / max(start - low, 1e-9), moved.max() / max(high - start, 1e-9))
            if 0 < model.upperVelocityLimit[joint.idx_v] < np.inf:
                fast = max(fast, float(speeds[place] / model.upperVelocityLimit[joint.idx_v]))
        return float(way), float(fast)
