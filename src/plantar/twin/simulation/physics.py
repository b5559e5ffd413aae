"""What the twin's world is made of: everything that changes the physics, nothing that only changes the sensors."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from plantar.twin.bush import PAPER, Feet
from plantar.twin.simulation.mjcf import FLOOR, FRICTION, TIMESTEP


@dataclass(frozen=True)
class Slip:
    """The floor is slippery from `start` to `end` [s of the motion]: friction falls to `friction`."""

    start: float
    end: float
    friction: float


@dataclass(frozen=True)
class Physics:
    """The bushes (None: rigid feet), the floor and its slippery seconds.

    `floor`: contact stiffness and damping per unit of mass [1/s², 1/s], and impedance; `settle` [s] passes before
    the log begins.
    """

    bushes: Feet | None = field(default_factory=lambda: PAPER)
    floor: tuple[float, float, float] = FLOOR
    friction: float = FRICTION
    slips: tuple[Slip, ...] = ()
    settle: float = 3.0
    timestep: float = TIMESTEP

    def stiffened(self, share: float) -> Physics:
        """The same world with stiffness and damping of pitch and roll larger by a share."""
        names = ("pitch_stiffness", "pitch_damping", "roll_stiffness", "roll_damping")
        bushes = {
            foot: replace(bush, **{name: (1 + share) * getattr(bush, name) for name in names})
            for foot, bush in (self.bushes or {}).items()
        }
        return replace(self, bushes=bushes) if self.bushes is not None else self
