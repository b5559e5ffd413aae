"""How numbers are written: rounded to what their uncertainty leaves."""

from __future__ import annotations

import pytest

from plantar.results.numbers import interval, number, with_uncertainty


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (480.04, 1.12, "480.0 ± 1.1"),
        (24.27, 0.39, "24.3 ± 0.4"),
        (949.2, 35.0, "949 ± 35"),
        (-0.051, 0.004, "−0.051 ± 0.004"),
        (5.0, None, "5.000"),
        (None, 1.0, "–"),
        (float("nan"), 1.0, "–"),
        (3.0, float("inf"), "3.000"),
        (2.0, 0.0, "2.000"),
    ],
)
def test_values_are_rounded_to_their_uncertainty(value: float | None, half: float | None, text: str) -> None:
    assert with_uncertainty(value, half) == text


def test_intervals_and_numbers_read_well() -> None:
    assert interval((947.02, 951.37)) == "947.0 to 951.4"
    assert interval(None) == "–"
    assert number(0.0) == "0"
    assert number(123456.0, 3) == "123456"
    assert number(1.234e-9, 3) == "1.23e−9"
