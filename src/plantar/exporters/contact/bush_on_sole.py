"""The law of a bush on a flat sole: spring, damper and slip, and a sole that tips over its edges and lifts.

Rows of three are z, roll and pitch. Corners f >= 0 of the sole push on the ground, so a wrench (force along z, torque
of roll, of pitch) can only be Σ f (1, y, -x). What spring, damper and slip would give beyond that tips the sole until
they give no more: among the wrenches that corners can push with, the bush then has the one that is nearest in the
metric of its compliance, which is the rest position of a bush between ankle and sole.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import nnls
from scipy.spatial import ConvexHull

from plantar.conventions import Array
from plantar.exporters.spring import Slip


@dataclass
class BushOnSole:
    """One foot. The slip remembers, so one object for each simulation, and one call a step.

    Args:
        stiffness, damping: (3,) [N/m, N·m/rad; N·s/m, N·m·s/rad]. slips: of roll and pitch.
        corners: of the sole about the bush, x forward and y left, (n, 2) [m].
    """

    stiffness: Array
    damping: Array
    slips: tuple[Slip | None, Slip | None]
    corners: Array
    yielded: list[float] = field(default_factory=lambda: [0.0, 0.0])  # of roll and pitch [rad]

    def __post_init__(self) -> None:
        outline = self.corners[ConvexHull(self.corners).vertices]  # counterclockwise
        self._pushes = np.column_stack([np.ones(len(outline)), outline[:, 1], -outline[:, 0]])
        # Inward normals of the cone that the pushes span.
        self._walls = np.cross(self._pushes, np.roll(self._pushes, -1, axis=0))

    def wrench(self, deflection: Array, rate: Array) -> Array:
        """The ground's force along z and torques of roll and pitch on the foot, (3,) [N, N·m].

        Args:
            deflection, rate: (3,) of the foot to the ground: compression, roll and pitch [m, rad; m/s, rad/s].
        """
        sides = [0.0, 0.0]  # of roll's and pitch's slip: it sticks, or yields that way
        sticks = True
        while sticks:
            wrench, bent = self._held(deflection, rate, sides)
            sticks = False
            for place, slip in enumerate(self.slips):
                strain = bent[1 + place] - self.yielded[place]
                if slip is not None and not sides[place] and abs(strain) > slip.angle:
                    sides[place], sticks = math.copysign(1.0, strain), True
        for place, slip in enumerate(self.slips):
            if slip is not None and sides[place]:
                self.yielded[place] = float(bent[1 + place]) - sides[place] * slip.angle
        return wrench

    def _held(self, deflection: Array, rate: Array, sides: Sequence[float]) -> tuple[Array, Array]:
        """The wrench, and how far the bush itself is bent, (3,) each, while slips stick or yield to these sides."""
        stiffness, wrench = self.stiffness.copy(), self.stiffness * deflection + self.damping * rate
        for place, slip in enumerate(self.slips):
            if slip is None:
                continue
            if sides[place]:
                wrench[1 + place] += sides[place] * slip.torque
            else:
                stiffness[1 + place] += slip.stiffness
                wrench[1 + place] += slip.stiffness * (deflection[1 + place] - self.yielded[place])
        if (self._walls @ wrench).min() >= 0:
            return wrench, deflection
        scale = 1 / np.sqrt(stiffness)
        held = nnls((self._pushes * scale).T, wrench * scale)[0] @ self._pushes
        return np.asarray(held), deflection - (wrench - held) / stiffness  # the sole turns by the rest

    def forget(self) -> None:
        """Of a foot that was lifted."""
        self.yielded = [0.0, 0.0]
