"""Settings of inertia and joints are checked where they are made."""

from __future__ import annotations

from typing import Any

import pytest

from plantar.errors import SettingsError
from plantar.whole_body.settings import DynamicsSettings


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"cutoff": -3.0}, r"^value -3\.0: cutoff is not valid \(valid: at least 0\.1 Hz\)$"),
        ({"as_recorded": "yes"}, r"^value 'yes': as_recorded is not valid \(valid: True, False\)$"),
    ],
)
def test_a_wrong_setting_is_one_line(given: dict[str, Any], expected: str) -> None:
    with pytest.raises(SettingsError, match=expected):
        DynamicsSettings(**given)
