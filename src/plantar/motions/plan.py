"""A planned motion: what every joint should do, where the root would be on rigid feet, and who holds the robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from plantar.conventions import Array
from plantar.robot.model import Placement

RATE = 200.0  # Hz


@dataclass(frozen=True)
class Hand:
    """An operator's hand: it holds `held` and leads it along `path` (N, 3) [m, world] through a spring and damper.

    The twin's operator is `spring` [N/m] and `damper` [N·s/m] between the robot and the path.
    """

    held: Placement
    path: Array
    spring: float = 3000.0
    damper: float = 150.0


@dataclass(frozen=True)
class Walk:
    """What a walk's balance is led by, at the plan's time.

    By foot, `soles` (N, 4, 4): poses in the world, and `stands` (N,): whether the foot is on the floor. `zmp` (N, 2)
    and `centre` (N, 3), the centre of mass [m].
    """

    soles: Mapping[str, Array]
    stands: Mapping[str, Array]
    zmp: Array
    centre: Array


@dataclass(frozen=True)
class Plan:
    """Joint positions (N, n) [rad or m] in the order of `joints`, at `time` (N,) [s].

    `base` (N, 4, 4) is the root link's pose in the world on rigid feet, the floor at z = 0; `standing` names the
    feet on the floor; `stance` says where the soles stand, (4, 4) each. A plan with a `walk` starts in that stance and
    leaves it.
    """

    name: str
    time: Array
    joints: tuple[str, ...]
    positions: Array
    base: Array
    standing: frozenset[str]
    stance: dict[str, Array]
    hand: Hand | None = None
    walk: Walk | None = None

    def standing_at(self, row: int) -> list[str]:
        """The feet on the floor at a row, by name in order."""
        if self.walk is None:
            return sorted(self.standing)
        return sorted(foot for foot, stands in self.walk.stands.items() if stands[row])
