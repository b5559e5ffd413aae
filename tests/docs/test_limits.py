"""The page of limits is the source's: a limit that changes is seen by whoever reads the change."""

from __future__ import annotations

import pytest

from limits_reference import PAGE, Limit, limits_in, page


def test_the_page_is_what_the_source_says() -> None:
    told, found = PAGE.read_text().splitlines(), page().splitlines()
    assert [line for line in told if line not in found] == []
    assert [line for line in found if line not in told] == []
    assert told == found


@pytest.mark.parametrize(
    ("source", "limits"),
    [
        ("LEAST = 0.02  # of the weight\n", [Limit("LEAST", "0.02", "of the weight")]),
        ("# rad: less is noise.\nLEAST: Final = 1e-3\n", [Limit("LEAST", "1e-3", "rad: less is noise.")]),
        ("LOW, HIGH = 0.1, 2 * np.pi  # Hz\n", [Limit("LOW, HIGH", "0.1, 2 * np.pi", "Hz")]),
        ("LEAST = (\n    3  # stances\n)\n", [Limit("LEAST", "3", "stances")]),
        ("PLACE = 3\n", []),
        ("# of a file\n\nPLACE = 3\n", []),
        ('NAME = "pitch"  # an axis\nnoise = 3.0  # no constant\n', []),
        ("STEPS = [1, 2]  # a list is no limit\n", []),
    ],
)
def test_a_limit_is_a_constant_number_with_a_reason(source: str, limits: list[Limit]) -> None:
    assert list(limits_in(source)) == limits
