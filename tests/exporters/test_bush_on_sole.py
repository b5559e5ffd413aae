"""The law of a bush on a sole, by statics: flat, over an edge, over a corner, in the air, and with a memory."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from plantar.exporters.contact.bush_on_sole import BushOnSole
from plantar.exporters.spring import Slip

K = np.array([2e5, 300.0, 400.0])  # z, roll, pitch
TOE, EDGE = 0.1, 0.06
CORNERS = np.array([[TOE, EDGE], [-TOE, -EDGE], [TOE, -EDGE], [-TOE, EDGE]])
STILL = np.zeros(3)


def foot(slips: tuple[Slip | None, Slip | None] = (None, None), damping: np.ndarray = STILL) -> BushOnSole:
    return BushOnSole(K, damping, slips, CORNERS)


def test_a_flat_sole_is_spring_and_damper() -> None:
    damping = np.array([500.0, 10.0, 20.0])
    deflection, rate = np.array([1e-3, 0.01, -0.02]), np.array([0.01, -0.1, 0.05])
    np.testing.assert_allclose(
        foot(damping=damping).wrench(deflection, rate), K * deflection + damping * rate
    )


@pytest.mark.parametrize(("axis", "arm"), [(1, EDGE), (2, TOE)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_over_an_edge_the_torque_is_the_load_at_that_edge_and_the_foot_rises(
    axis: int, arm: float, sign: float
) -> None:
    """The sole turns by what the bush does not; its middle rises by arm times that, which presses the bush in."""
    angle, pressed = 0.2, 1e-3
    deflection = np.array([pressed, 0.0, 0.0])
    deflection[axis] = sign * angle
    bent = K[0] * arm * (pressed + arm * angle) / (K[axis] + K[0] * arm**2)
    wrench = foot().wrench(deflection, STILL)
    assert wrench[axis] == pytest.approx(sign * K[axis] * bent)
    assert wrench[0] == pytest.approx(K[axis] * bent / arm)
    assert wrench[3 - axis] == pytest.approx(0.0, abs=1e-9)


def test_over_a_corner_the_energy_is_least() -> None:
    """Among all poses of a sole with no corner in the ground, the bush's energy is least where the law has it."""
    deflection = np.array([1e-3, 0.08, 0.09])

    def energy(sole: np.ndarray) -> float:
        return float(0.5 * K / 1e3 @ (deflection - sole) ** 2)

    above = [{"type": "ineq", "fun": lambda s, x=x, y=y: -(s[0] + y * s[1] - x * s[2])} for x, y in CORNERS]
    found = minimize(energy, np.zeros(3), constraints=above, method="SLSQP", options={"ftol": 1e-14})
    np.testing.assert_allclose(foot().wrench(deflection, STILL), K * (deflection - found.x), rtol=1e-3)


def test_a_foot_in_the_air_is_pushed_by_nothing() -> None:
    np.testing.assert_allclose(foot().wrench(np.array([-1e-3, 0.002, 0.0]), STILL), 0.0, atol=1e-12)


def test_rubber_under_a_tipping_sole_yields_by_its_own_bend_and_not_by_the_foots_angle() -> None:
    law = foot((None, Slip(5.0, 0.01)))
    flat = np.array([1e-3, 0.0, 0.0])
    tipped = law.wrench(flat + [0.0, 0.0, 0.3], STILL)
    bent = law.yielded[1] + 0.01
    assert tipped[2] == pytest.approx(TOE * tipped[0])
    assert tipped[2] == pytest.approx(K[2] * bent + 5.0)
    assert bent == pytest.approx((K[0] * TOE * (1e-3 + TOE * 0.3) - 5.0) / (K[2] + K[0] * TOE**2))
    law.forget()
    assert law.yielded == [0.0, 0.0]


def test_rubber_that_sticks_under_a_tipped_sole_has_not_yielded() -> None:
    """Hardly loaded, on its toes: the foot has turned by five times the slip angle, its bush by a seventh of it."""
    law = foot((None, Slip(5.0, 0.01)))
    lifted, angle = 2e-4 - TOE * 0.05, 0.05
    bent = K[0] * TOE * (lifted + TOE * angle) / (K[2] + 500.0 + K[0] * TOE**2)
    wrench = law.wrench(np.array([lifted, 0.0, angle]), STILL)
    assert wrench[2] == pytest.approx((K[2] + 500.0) * bent)
    assert wrench[0] == pytest.approx(wrench[2] / TOE)
    assert law.yielded == [0.0, 0.0]
