"""How deep the fit of one foot goes: a reader has to follow few functions down to the linear algebra."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import pytest

import plantar
from biped import SLIPPING, record, sway
from biped_robot import make_robot
from feet_trials import PUNCTUAL, noisy
from plantar import cores
from plantar.feet.foot_assessment import assess_foot
from plantar.feet.foot_fit import between_all, fit_foot, without_needless
from plantar.feet.identify import identify_feet
from plantar.feet.prepare_log import checked
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.delays.refined_delays import residuals_at

DEEPEST = 10
DEEPEST_OF_STEPS = 12  # of a foot that steps: its reduced sums are kept, which takes two functions more
STATES = 2  # more to the states of a model, which are no linear algebra: what columns it has, and which element moves
SOURCE = str(Path(plantar.__file__).parent)
SOLVERS = {"qr", "lstsq", "solve", "pinv", "svd", "svdvals", "eigh", "inv", "cholesky", "solve_triangular"}
Path_ = tuple[str, ...]
FROM = {
    each.__code__ for each in (checked, residuals_at, fit_foot, between_all, without_needless, assess_foot)
}


def path_to(frame: FrameType) -> Path_:
    """The package's functions from a step of `FROM`, or the first of the thread, to a frame, both counted.

    Comprehensions, lambdas and the map over cores are no functions that a reader jumps to; one that calls itself counts
    each time.
    """
    found: list[str] = []
    step: FrameType | None = frame
    while step is not None:
        code = step.f_code
        named = code is not cores.over_cores.__code__ and not code.co_name.startswith("<")
        if code.co_filename.startswith(SOURCE) and named:
            found.append(f"{code.co_filename[len(SOURCE) + 1 :]}:{code.co_name}")
        if code in FROM:
            break
        step = step.f_back
    return tuple(reversed(found))


@contextmanager
def solved_at(paths: set[Path_]) -> Iterator[None]:
    """Collects, in every thread, the path to each call of the native core, a QR, or another solver."""

    def watch(frame: FrameType, event: str, _: object) -> None:
        if event != "call" or (caller := frame.f_back) is None:
            return
        code = frame.f_code
        if code.co_filename.startswith(SOURCE):
            if "_core" in code.co_names:
                paths.add(path_to(frame))
        elif code.co_name in SOLVERS and caller.f_code.co_filename.startswith(SOURCE):
            paths.add(path_to(caller))

    profile: Callable[..., None] = watch
    threading.setprofile(profile)
    sys.setprofile(profile)
    try:
        yield
    finally:
        sys.setprofile(None)
        threading.setprofile(None)  # type: ignore[arg-type]


def assert_shallow(
    robot: RobotModel, logs: list[MotionLog], settings: FeetSettings, deepest: int, *named: str
) -> None:
    """No path deeper than `deepest`, and paths through each function `named`, so that what is deep was reached."""
    paths: set[Path_] = set()
    with solved_at(paths), pytest.MonkeyPatch.context() as patch:
        patch.setattr(cores, "usable_cores", lambda: 1)  # nobody watches copies of this process
        identify_feet(robot, logs, settings=settings)
    for name in named:
        assert any(name in step for path in paths for step in path), f"{name} was not reached"
    deep = [
        " > ".join(path) for path in paths if len(path) > deepest + STATES * path[-1].startswith("models/")
    ]
    assert deep == [], "\n".join(deep)


def test_logs_that_ask_for_delays_and_a_choice_of_models(tmp_path: Path) -> None:
    assert_shallow(
        make_robot(tmp_path),
        [noisy(record(sway("sway", 4, duration=12.0)), 2)],
        FeetSettings(),
        DEEPEST,
        "contact/deflection.py",
        "foot_fit.py:fit_foot",
        "model_fit.py:refine",
    )


def test_a_memory_beside_an_attitude_that_drifts(tmp_path: Path) -> None:
    assert_shallow(
        make_robot(tmp_path),
        [noisy(record(sway("sway", 4, duration=12.0, truth=SLIPPING)), 2)],
        FeetSettings(model="elastoplastic", wrench_delay=0.0),
        DEEPEST,
        "angle_drift.py:beside_drift",
        "models/elastoplastic.py",
    )


def test_steps_whose_stances_have_offsets_of_their_own(tmp_path: Path) -> None:
    lifts = tuple(("left", 3.5 * k, 3.5 * k + 0.5) for k in range(1, 7))
    motion = sway("steps", 4, duration=24.0, lifts=lifts)
    assert_shallow(
        make_robot(tmp_path),
        [noisy(record(motion), 2)],
        PUNCTUAL,
        DEEPEST_OF_STEPS,
        "stance_problem.py",
        "model_fit.py:refine",
    )
