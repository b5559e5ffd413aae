"""What walks say one by one comes back from the file, and is not there where no foot steps."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from plantar.errors import PlantarError
from plantar.results.feet import FeetResult
from plantar.results.walk_rows import StanceStiffness, SwingZero, WalkStiffness

STANCE = StanceStiffness("walk", "validate", "left", "roll", 1.0, 1.75, 480.5, 0.03)
WALK = WalkStiffness("walk", "validate", "left", "roll", 7, 482.0, (470.0, 494.0))
ZERO = SwingZero(
    "walk", "left", 2.5, (1.0, -2.0, -40.0), (0.1, 0.2, 0.3), (1.1, -2.1, -41.0), (0.1, 0.2, 0.25)
)


def result(**rows: object) -> FeetResult:
    return FeetResult("biped", (), {}, "kelvin_voigt", (), (), (), (), (), **rows)  # type: ignore[arg-type]


def test_rows_of_walks_come_back(tmp_path: Path) -> None:
    path = result(stances=(STANCE,), walks=(WALK,), swing_zeros=(ZERO,)).save(tmp_path)
    again = FeetResult.load(path)
    assert (again.stances, again.walks, again.swing_zeros) == ((STANCE,), (WALK,), (ZERO,))


def test_a_result_of_feet_that_stand_names_none() -> None:
    assert not {"stances", "walks", "swing_zeros"} & result().to_dict().keys()


@pytest.mark.parametrize(
    ("key", "name"), [("stances", "share"), ("walks", "interval95"), ("swing_zeros", "force")]
)
def test_a_broken_row_is_one_line(tmp_path: Path, key: str, name: str) -> None:
    path = result(stances=(STANCE,), walks=(WALK,), swing_zeros=(ZERO,)).save(tmp_path)
    content = json.loads(path.read_text())
    content[key][0][name] = "much"
    path.write_text(json.dumps(content))
    with pytest.raises(PlantarError, match=re.escape(f"{key}.0.{name}")) as caught:
        FeetResult.load(path)
    assert "\n" not in str(caught.value)
