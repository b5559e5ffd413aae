"""What rubber does beside its spring and damper: it hardens, and it yields."""

from __future__ import annotations

from plantar.twin.bush import Bush


class Element:
    """One axis: a cubic spring, and an elastoplastic (Jenkins) element, a spring that slips at a fixed torque.

    The element's state is its elastic angle; it follows the deflection until `slip_angle` and then yields.
    """

    def __init__(self, slip_torque: float, slip_angle: float, hardening: float) -> None:
        self.stiffness = slip_torque / slip_angle
        self.limit = slip_angle
        self.hardening = hardening
        self.elastic = 0.0
        self.last = 0.0

    def torque(self, angle: float) -> float:
        """Torque against a deflection [N·m]; call once a step, the history counts."""
        elastic = self.elastic + angle - self.last
        limit = self.limit
        self.last = angle
        self.elastic = elastic = limit if elastic > limit else -limit if elastic < -limit else elastic
        return self.stiffness * elastic + self.hardening * angle * angle * angle


def elements(bush: Bush) -> dict[str, Element]:
    """The elements of one foot, by axis; none where the bush is a plain spring and damper."""
    if bush.is_linear:
        return {}
    return {
        "pitch": Element(bush.pitch_slip_torque, bush.pitch_slip_angle, bush.pitch_hardening),
        "roll": Element(bush.roll_slip_torque, bush.roll_slip_angle, bush.roll_hardening),
    }
