"""Balance of a walking robot: from how it stands to the load and the torque that each foot should have.

The divergent component of motion ξ = c + ċ/ω runs away from the zero-moment point p: ξ̇ = ω (ξ - p). Leading p beyond
ξ's error brings it back (Englsberger 2015, Caron 2019). What the ZMP asks for is shared between the feet.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.motions.plan import RATE, Plan
from plantar.motions.preview import natural_frequency
from plantar.robot.model import RobotModel
from plantar.twin.walking.balance_state import State

LEAD: Final = 3.0  # times ξ's error; 1 stops it, more brings it back with ω (LEAD - 1)
LEARN: Final = 1.0  # 1/s: how fast a lasting error is learnt
MOST_LEARNT: Final = 0.02  # m
USED: Final = 0.85  # of the sole's half size: nearer to its edge it tips
# Of the sole's half size: in double support no foot's centre of pressure leaves it without need.
FLAT: Final = 0.35


@dataclass(frozen=True)
class Asked:
    """What one foot should carry: `load` [N], and `torque` (2,) [N·m] about the bush's roll and pitch axes."""

    load: float
    torque: Array


class Stabiliser:
    """Asks for each foot's load and torque, sample by sample."""

    def __init__(self, robot: RobotModel, plan: Plan) -> None:
        assert plan.walk is not None
        self.walk, self.feet = plan.walk, tuple(robot.feet)
        self.frequency = natural_frequency(float(self.walk.centre[0, 2]))
        rate = np.gradient(self.walk.centre[:, :2], plan.time, axis=0)
        self.divergent = self.walk.centre[:, :2] + rate / self.frequency
        self.weight = robot.mass * GRAVITY
        self.half, self.middle, self.rise = {}, {}, {}
        for name, foot in robot.feet.items():
            low, high = foot.sole.polygon.min(axis=0), foot.sole.polygon.max(axis=0)
            bush = robot.frame(foot.sole.placement)[1].inverse() * robot.frame(foot.bush)[1]
            self.half[name] = (high - low) / 2
            self.middle[name] = (high + low) / 2 - bush.translation[:2]
            self.rise[name] = float(bush.translation[2])
        self.learnt = np.zeros(2)

    def ask(self, sample: int, state: State) -> dict[str, Asked]:
        """Loads and torques of this sample."""
        divergent = state.centre[:2] + state.centre_rate[:2] / self.frequency
        error = divergent - self.divergent[sample]
        self.learnt = np.clip(self.learnt + LEARN * error / RATE, -MOST_LEARNT, MOST_LEARNT)
        wanted = self.walk.zmp[sample] + LEAD * error + self.learnt
        standing = [foot for foot in self.feet if self.walk.stands[foot][sample]]
        pressures, shares = self._shared(sample, wanted, standing, state.place)
        zmp = sum((shares[foot] * pressures[foot] for foot in standing), start=np.zeros(2))
        pull = self.weight * (state.centre[:2] - zmp) / self.walk.centre[sample, 2]  # of the floor, sideways
        asked = {}
        for foot in self.feet:
            if foot not in standing:
                asked[foot] = Asked(0.0, np.zeros(2))
                continue
            turn = self.walk.soles[foot][sample, :2, :2]
            arm = turn.T @ (pressures[foot] - state.place[foot][:2])
            load, sideways = shares[foot] * self.weight, shares[foot] * turn.T @ pull
            rise = self.rise[foot]
            asked[foot] = Asked(
                load, np.array([arm[1] * load + rise * sideways[1], -arm[0] * load - rise * sideways[0]])
            )
        return asked

    def _shared(
        self, sample: int, wanted: Array, standing: list[str], place: Mapping[str, Array]
    ) -> tuple[dict[str, Array], dict[str, float]]:
        """Centre of pressure (2,) in the world and share of the weight, of each foot that stands."""
        near = {foot: self._on_sole(sample, foot, wanted, place, FLAT) for foot in standing}
        if len(standing) == 1:
            shares = {standing[0]: 1.0}
        else:
            one, other = (near[foot] for foot in standing)
            between = other - one
            apart = max(float(between @ between), 1e-9)
            share = float(np.clip((wanted - one) @ between / apart, 0.0, 1.0))
            shares = {standing[0]: 1 - share, standing[1]: share}
        left = wanted - sum((shares[foot] * near[foot] for foot in standing), start=np.zeros(2))
        return {
            foot: self._on_sole(sample, foot, near[foot] + left, place, USED) for foot in standing
        }, shares

    def _on_sole(
        self, sample: int, foot: str, point: Array, place: Mapping[str, Array], used: float
    ) -> Array:
        """The nearest point (2,) of the `used` part of a sole, in the world."""
        turn, middle, half = self.walk.soles[foot][sample, :2, :2], self.middle[foot], used * self.half[foot]
        local = np.clip(turn.T @ (point - place[foot][:2]) - middle, -half, half) + middle
        return np.asarray(place[foot][:2] + turn @ local)
