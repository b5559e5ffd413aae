"""Logs are worked on one after another unless one of them is long."""

from __future__ import annotations

from threading import current_thread, main_thread

import numpy as np
import pytest

from plantar.feet.first_look import over_logs
from plantar.logs.motion_log import MotionLog

LONG = 50000


@pytest.mark.parametrize(("samples", "here"), [(LONG, True), (LONG + 1, False)])
def test_threads_are_for_long_logs(samples: int, here: bool) -> None:
    logs = [MotionLog("log", np.arange(float(count)), {}) for count in (2, samples)]
    with over_logs(logs) as each:
        places = list(each(lambda _: current_thread() is main_thread(), logs))
    assert places == [here, here]
