"""How numbers are written: rounded to what their uncertainty leaves."""

from __future__ import annotations

import pytest

from plantar.results.numbers import interval, number, unit, with_uncertainty


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (480.04, 1.12, "480.0 ± 1.1"),
        (24.27, 0.39, "24.3 ± 0.4"),
        (949.2, 35.0, "949 ± 35"),
        (239136.0, 96170.0, "239000 ± 96000"),
        (951.2, 312.0, "950 ± 310"),
        (-0.051, 0.004, "−0.051 ± 0.004"),
        (-0.0003, 0.1, "0.00 ± 0.10"),  # rounded to zero: no minus
        (5.0, None, "5.000"),
        (None, 1.0, "–"),
        (float("nan"), 1.0, "–"),
        (3.0, float("inf"), "3.000"),
        (2.0, 0.0, "2.000"),
        (1.37e8, 1.33e8, "1.4e8 ± 1.3e8"),
        (-2.0e7, 4.0e5, "−2.00e7 ± 0.04e7"),
    ],
)
def test_values_are_rounded_to_their_uncertainty(value: float | None, half: float | None, text: str) -> None:
    assert with_uncertainty(value, half) == text


def test_intervals_and_numbers_read_well() -> None:
    assert interval((947.02, 951.37)) == "947.0 to 951.4"
    assert interval((12345.6, 23456.7)) == "12300 to 23500"
    assert interval((3857549.0, 2.701e8)) == "0.04e8 to 2.70e8"
    assert interval((-1.0, 2.5e7)) == "0.00e7 to 2.50e7"
    assert interval(None) == "–"
    assert number(0.0) == "0"
    assert number(123456.0, 3) == "123456"
    assert number(1.234e-9, 3) == "1.23e−9"


def test_units_are_printed_as_people_write_them() -> None:
    assert unit("N.m.s/rad") == "N·m·s/rad"
    assert unit("1") == ""
