"""How far bush, force sensor and IMU may be from where the robot file says: a standing foot's prior."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import SHOWN, Array, Axis
from plantar.feet.place.place_notes import FAR, FARTHEST, PLACE
from plantar.feet.regression.axis import AxisFit
from plantar.robot.model import RobotModel
from plantar.sensors.load_errors import TURN

GUESSED = 0.02  # m: what a guess without a spread of its own may be off by
ALIKE = 0.5  # of another foot's height above the robot file's place


@dataclass(frozen=True)
class PlaceSpread:
    """Deviation of the centre's place, `aside` and `above` [m], and of how far force sensor or IMU are `turned` [rad]
    about any axis. `height` [m]: how far above the robot file's place the other axis shows the centre; `between` [m]:
    by how much the axes' heights may seem to differ."""

    aside: float
    above: float
    turned: float
    height: float = 0.0
    between: float = np.inf

    @property
    def deviations(self) -> Array:
        """Of the centre's place, the force sensor's yaw, and the IMU's turn about three axes, (6,)."""
        return np.array([self.aside, self.above, *[self.turned] * 4])

    @property
    def measured(self) -> bool:
        """Whether the robot file knows the place better than FARTHEST is far: of a guess nothing is too far.

        By `aside`, which is as the robot file has it: `above` grows where a foot's motions put the file in doubt.
        """
        return bool(SHOWN * self.aside < FARTHEST[0])

    @property
    def expected(self) -> Array:
        """The deviations, that of the height from what the other axis shows where it does, (6,)."""
        known = min(self.above, self.between) if self.height else self.above
        return np.array([self.aside, known, *[self.turned] * 4])

    def known_from(self, fits: Mapping[Axis, AxisFit], axis: Axis) -> PlaceSpread | None:
        """Expecting the height that the other axis shows, where that is far off, and farther than this axis shows it.

        Bush and force sensor have one height: a robot file that is wrong about it is so for both axes, and draws the
        one more to itself whose motions show less. What is guessed is guessed of both axes at once: they differ less.
        """
        (height,) = (fit.moment_arms[1] for other, fit in fits.items() if other != axis)
        above = min(self.above, self.between)
        far = abs(height) > max(SHOWN * above, abs(fits[axis].moment_arms[1]))
        return replace(self, height=height) if far else None

    def doubted_by(self, others: Sequence[AxisFit], own: Sequence[AxisFit]) -> PlaceSpread:
        """Wide enough for the height that motions show at another foot: who is wrong about one foot is about both.

        As it is where no other foot shows it far off, or this one's own motions show as much.
        """
        told = [fit for fit in others if any(note.code in (PLACE, FAR) for note in fit.notes)]
        height = max((abs(fit.moment_arms[1]) for fit in told), default=0.0)
        least = min((abs(fit.moment_arms[1]) for fit in own), default=height)
        doubted = height > SHOWN * self.above and least < ALIKE * height
        return replace(self, above=height) if doubted else self

    @classmethod
    def of(cls, robot: RobotModel, foot: str) -> PlaceSpread:
        """From the robot file: its uncertainty, and what its guesses of bush and force sensor may be off by."""
        if robot.feet[foot].contact == "always":  # its sensor was zeroed under load: the load is not known
            return cls(0.0, 0.0, 0.0)
        position, turned = robot.uncertainty.bush_position, robot.uncertainty.imu_mount
        for guess in robot.guesses:
            if guess.key == "imu" and turned:
                turned = max(turned, TURN)
            if guess.key.startswith((f"feet.{foot}.bush", f"feet.{foot}.wrench")):
                position = max(position, GUESSED if guess.spread is None else guess.spread)
        # Of a force sensor, a force that shows in a torque is like an arm: of the load aside, of the others above.
        crosstalk = robot.uncertainty.wrench_crosstalk
        arm = float(np.hypot(position, crosstalk))
        measured = float(np.hypot(robot.uncertainty.bush_position, crosstalk))
        return cls(arm, arm, turned, between=measured or np.inf)
