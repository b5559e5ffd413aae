"""One recording, resampled or written otherwise, is known by the noise of its sensors; two of one motion are two."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from plantar.errors import DataError
from plantar.logs.inputs import check_names
from plantar.logs.motion_log import MotionLog
from plantar.logs.same_recording import same_noise

TIME = np.arange(0, 30, 0.005)
COLUMNS = [f"wrench.{foot}.force.{axis}" for foot in ("left", "right") for axis in "xyz"]


def recording(
    name: str, seed: int, noise: float = 0.02, stiffness: float = 1.0, time: np.ndarray = TIME
) -> MotionLog:
    """Forces of one motion, swaying with an impact in each second, whose noise is drawn by `seed`."""
    drawn = np.random.default_rng(seed)
    sway = np.sin(2 * np.pi * 0.3 * time) + 0.3 * np.sin(2 * np.pi * 1.1 * time)
    after = time % 1.0
    knock = np.exp(-after / 0.03) * np.sin(2 * np.pi * 28 * after) / stiffness
    forces = {
        column: (place + 1) * (sway + knock) + noise * drawn.standard_normal(len(time))
        for place, column in enumerate(COLUMNS)
    }
    return MotionLog(name, time, forces)


def at(log: MotionLog, time: np.ndarray, name: str = "again", later: float = 0.0) -> MotionLog:
    """What a script makes of a log that reads it at other times, on a clock that begins `later`."""
    columns = {column: np.interp(time, log.time, values) for column, values in log.columns.items()}
    return MotionLog(name, time - later, columns)


def filtered(log: MotionLog) -> MotionLog:
    low = butter(2, 30, fs=200, output="sos")
    return MotionLog(
        log.name, log.time, {name: sosfiltfilt(low, values) for name, values in log.columns.items()}
    )


AGAIN: dict[str, Callable[[MotionLog], MotionLog]] = {
    "in single precision": lambda log: MotionLog(
        "again",
        log.time,
        {name: values.astype(np.float32).astype(float) for name, values in log.columns.items()},
    ),
    "five times as fast": lambda log: at(log, np.arange(0.0003, 29.9, 0.001)),
    "half a sample later": lambda log: at(log, log.time[:-1] + 0.0023),
    "slower, cut, on another clock": lambda log: at(log, np.arange(8.0023, 22, 1 / 137), later=8.0023),
    "filtered and thinned": lambda log: at(filtered(log), np.arange(3.001, 29, 0.01)),
    "behind another one": lambda log: MotionLog(
        "again",
        np.arange(9000) * 0.005,
        {
            name: np.r_[before, log.columns[name] + 1e-6]
            for name, before in recording("", 9, time=TIME[:3000]).columns.items()
        },
    ),
}


@pytest.mark.parametrize("how", AGAIN)
def test_one_recording_written_otherwise_is_refused(how: str) -> None:
    log = recording("log", 1)
    again = AGAIN[how](log)
    other = recording("other", 2)
    for logs in ([log, other, again], [again, other, log]):
        with pytest.raises(DataError, match=r"log and again|again and log") as refused:
            check_names(logs)
        assert "resampled or written otherwise" in str(refused.value)


def test_one_motion_played_twice_is_two_recordings() -> None:
    logs = [recording("one", 1), recording("two", 2), at(recording("third", 3), TIME[:-1] + 0.002)]
    assert not list(same_noise(logs))
    check_names(logs)


def test_simulations_without_noise_are_alike_and_yet_two() -> None:
    """Of one motion on other rubber: nothing but the size of the knocks differs, far below any sensor's noise."""
    slow = np.arange(0, 30, 0.01)
    quiet = [recording(f"{size}", 1, 1e-7, 1e4 * size, slow) for size in (1.0, 1.04)]
    assert not list(same_noise(quiet))


def test_what_has_no_force_sensors_in_common_or_is_too_short_or_slow_tells_nothing() -> None:
    log = recording("log", 1)
    joints = MotionLog("joints", TIME, {"joint.a.position": log.columns[COLUMNS[0]]})
    short = [recording(name, 1, time=TIME[:300]) for name in ("a", "b")]
    slow = [recording(name, 1, time=np.arange(0, 30, 0.05)) for name in ("a", "b")]
    for logs in ([log, joints], [joints, joints], short, slow, [log], []):
        assert not list(same_noise(logs))


def test_dead_columns_and_empty_cells_hide_no_copy() -> None:
    log = recording("log", 1)
    holes = {
        name: np.where(np.arange(len(TIME)) % 50 < 3, np.nan, values) for name, values in log.columns.items()
    }
    empty = dict.fromkeys(COLUMNS[:2], np.full(len(TIME), np.nan)) | {COLUMNS[2]: np.zeros(len(TIME))}
    again = at(MotionLog("log", TIME, log.columns), TIME[:-1] + 0.002)
    assert len(list(same_noise([MotionLog("log", TIME, holes | empty), again]))) == 1


def test_a_simulators_noise_may_be_the_same_in_two_motions() -> None:
    """Drawn by one seed for every log, as scripts do."""
    noise = 0.02 * np.random.default_rng(3).standard_normal((len(COLUMNS), len(TIME)))
    slow, quick = (
        MotionLog(name, TIME, dict(zip(COLUMNS, np.sin(2 * np.pi * hertz * TIME) + noise, strict=True)))
        for name, hertz in (("slow", 0.3), ("quick", 0.47))
    )
    check_names([slow, quick])
    again = MotionLog("again", TIME + 0.0, {name: values + 1e-9 for name, values in slow.columns.items()})
    with pytest.raises(DataError, match="slow and again"):
        check_names([slow, quick, again])
