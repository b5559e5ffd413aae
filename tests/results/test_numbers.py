"""How numbers are written: rounded to what their uncertainty leaves."""

from __future__ import annotations

import pytest

from plantar.results.numbers import decimals_for, interval, number, percent, unit, with_uncertainty


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
    assert interval(None) == interval((1.0, float("inf"))) == interval((float("nan"), 1.0)) == "–"
    # Ends as narrow as rounding, or exchanged, are numbers.
    assert interval((2.0, 2.0 + 5e-7)) == "2.000 to 2.000"
    assert interval((3.5, 2.25)) == "3.500 to 2.250"
    assert interval((-4.2, -1.1)) == "−4.2 to −1.1"
    assert number(0.0) == "0"
    assert number(123456.0, 3) == "123456"
    assert number(1.234e-9, 3) == "1.23e−9"
    assert number(None) == number(float("inf")) == "–"
    assert (number(-0.00012346), number(0.000099)) == ("−0.0001235", "9.900e−5")
    assert (number(9999999.0), number(1e7)) == ("9999999", "1.000e7")
    assert (number(123456.0, 2), number(99999.4, 2)) == ("1.2e5", "99999")
    assert (percent(0.314), percent(None), percent(float("nan"))) == ("0.31 %", "–", "–")


@pytest.mark.parametrize(
    ("uncertainty", "decimals"),
    [(0.0294, 3), (0.0296, 2), (0.2, 2), (0.3, 1), (1.0, 1), (2.96, 0), (9.9, 0), (10.0, 0), (29.6, 0), (300.0, -1),
     (1e-13, 12)],
)  # fmt: skip
def test_two_digits_are_left_of_an_uncertainty_that_begins_with_one_or_two(
    uncertainty: float, decimals: int
) -> None:
    """From ten on always two."""
    assert decimals_for(uncertainty) == decimals


def test_units_are_printed_as_people_write_them() -> None:
    assert unit("N.m.s/rad") == "N·m·s/rad"
    assert unit("1") == ""
    assert [unit(name) for name in ("N.m/rad", "N.m/rad3", "N.s/m", "kg.m2", "N.m", "rad")] == [
        "N·m/rad", "N·m/rad³", "N·s/m", "kg·m²", "N·m", "rad"
    ]  # fmt: skip
