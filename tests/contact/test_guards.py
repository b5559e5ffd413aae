"""Small parts of contact, each by a case that is solved by hand."""

from __future__ import annotations

import numpy as np

from plantar.contact.phases import AIR, DOUBLE, SINGLE, SUPPORTS, TRANSITION, detect_contact


def test_a_foot_in_the_air_is_in_no_double_support_of_others() -> None:
    """Of three feet, while two of them stand."""
    stands, period = np.full(1000, 300.0), 0.01
    lifted = np.where(np.arange(1000) < 500, 300.0, 0.0)
    force = {"a": stands, "b": stands, "c": lifted}
    found = detect_contact(force, dict.fromkeys(force, False), 900.0, period)
    codes = {foot: [SUPPORTS[code] for code in contact.support[[50, 950]]] for foot, contact in found.items()}
    assert codes == {"a": [DOUBLE, DOUBLE], "b": [DOUBLE, DOUBLE], "c": [DOUBLE, AIR]}
    alone = detect_contact({"a": stands, "b": lifted}, {"a": False, "b": False}, 600.0, period)
    assert SUPPORTS[alone["a"].support[950]] == SINGLE
    assert TRANSITION in {SUPPORTS[code] for code in alone["b"].support[480:520]}
