"""Terms of joints: each times its column is a torque, in numbers and in units."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.whole_body.equations import TERM_UNITS, term_columns

TORQUE = {"N": 1, "m": 1}
COLUMNS = {
    "viscous": {"rad": 1, "s": -1},
    "coulomb": {},
    "offset": {},
    "stiffness": {"rad": 1},
    "inertia": {"rad": 1, "s": -2},
}


def powers(unit: str) -> dict[str, int]:
    """`N.m.s/rad` as powers of its parts; a kilogram is N·s²/m, and a radian has none."""
    found: dict[str, int] = {}
    above, _, below = unit.partition("/")
    for side, sign in ((above, 1), (below, -1)):
        for part in filter(None, side.split(".")):
            name = part.rstrip("0123456789")
            size = sign * int(part[len(name) :] or 1)
            for own, times in {"kg": {"N": 1, "s": 2, "m": -1}}.get(name, {name: 1}).items():
                found[own] = found.get(own, 0) + size * times
    return found


@pytest.mark.parametrize("slides", [False, True])
@pytest.mark.parametrize("term", TERM_UNITS)
def test_a_terms_unit_times_its_columns_is_a_torque_or_of_a_slide_a_force(term: str, slides: bool) -> None:
    product, place = powers(TERM_UNITS[term][slides]), "m" if slides else "rad"
    for name, power in COLUMNS[term].items():
        own = place if name == "rad" else name
        product[own] = product.get(own, 0) + power
    product.pop("rad", None)
    wanted = {"N": 1} if slides else TORQUE
    assert {name: power for name, power in product.items() if power} == wanted
    radians = 0 if slides else powers(TERM_UNITS[term][slides]).get("rad", 0) + COLUMNS[term].get("rad", 0)
    assert radians in (0, 1 if term == "inertia" else 0)


def test_columns_are_the_states_that_terms_are_named_for() -> None:
    position, velocity, acceleration, sense = (np.full(3, value) for value in (1.0, 2.0, 3.0, -1.0))
    terms = ("stiffness", "viscous", "inertia", "coulomb", "offset")
    columns = term_columns(terms, position, velocity, acceleration, sense)
    assert [column.tolist() for column in columns] == [[value] * 3 for value in (1.0, 2.0, 3.0, -1.0, 1.0)]
