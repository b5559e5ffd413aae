"""Stiffness, damping and offset of each foot from what the robot recorded (paper, sections 3 and 4)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from plantar.choices import settings_of
from plantar.contact.phases import carried_weight
from plantar.conventions import GRAVITY
from plantar.cores import blas_on_one_core, over_cores
from plantar.errors import DataError
from plantar.feet.foot_assessment import assess_foot, without_soft_imu
from plantar.feet.foot_fit import FittedFoot, between_all, fit_foot, without_needless
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.place.told_exact import as_measured
from plantar.feet.prepare import PreparedLogs, prepare_all
from plantar.feet.put_right.encoders_of_fits import (
    Late,
    encoders_shown,
    newton_told,
    read_at,
    retold,
    tried_first,
)
from plantar.feet.put_right.imu_of_steps import is_worth, put_right, turn_shown
from plantar.feet.result import feet_result
from plantar.feet.settings import FeetSettings
from plantar.feet.shared_hysteresis import with_shared_hysteresis
from plantar.logs.freed_memory import return_freed
from plantar.logs.inputs import LogInputs, RobotInput, logs_of, robot_of
from plantar.logs.stretches import LONGEST
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel

TURN_ROUNDS = 2  # of fitting again with the IMU's turn: what a fit took up of it before shows in the next


@blas_on_one_core()
def identify_feet(
    robot: RobotInput,
    logs: LogInputs,
    validate: LogInputs = (),
    settings: FeetSettings | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> FeetResult:
    """Stiffness, damping and offset of each foot, in pitch and roll, of a robot that stands or walks (eq. 4 to 7).

    All `logs` are fitted together; the scores on them are direct validation, those on `validate` cross-validation.

    Args:
        robot: a robot with feet, or the path of its robot file.
        logs: logs to fit, or their paths; one or several.
        validate: logs to score only.
        settings: what to choose by hand; all is found by itself where left out.
        progress: called with a line for each step.

    Returns:
        Parameters [N·m/rad, N·m·s/rad] with 95 % intervals and verdicts, offsets [N·m], scores, and notes on what was
        assumed or left out.

    Raises:
        RobotError: the robot file is wrong. LogError: a log cannot be read. DataError: nothing can be fitted to them.
        Each is one line that names file, column and time, and what would be valid.

    Example:
        >>> import plantar
        >>> known = plantar.FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
        >>> result = plantar.identify_feet("robot.yaml", ["sway_1.csv", "sway_2.csv"], "squat.csv", known)
        >>> stiffness = result.parameter("left", "pitch", "stiffness")
        >>> f"{stiffness.value:.0f} {stiffness.unit}, {stiffness.verdict}"
        '420 N.m/rad, usable'
        >>> result.save("out/mine").name
        'result.json'
    """
    robot = robot_of(robot)
    ready = prepare_all(
        robot,
        logs_of(logs, robot, LONGEST),
        logs_of(validate, robot, LONGEST),
        settings_of(settings, FeetSettings),
        progress,
    )
    return fit_prepared(robot, ready, progress)


def fit_prepared(
    robot: RobotModel,
    ready: PreparedLogs,
    progress: Callable[[str], None] = lambda _: None,
    *,
    residuals: bool = True,
) -> FeetResult:
    """`identify_feet` on logs that are ready, without the table of `residuals` where nobody reads it. Raises DataError
    where no foot carries load in any log."""
    logs = [recording.log for recording in ready.fitted]
    if not any(recording.contacts[foot].standing.any() for recording in ready.fitted for foot in robot.feet):
        names = ", ".join(log.name for log in logs)
        loads = ({foot: bush.force_z for foot, bush in one.raw.items()} for one in ready.fitted)
        carried = max(map(carried_weight, loads)) / GRAVITY
        text = f"no foot carries load in any log: {carried:.1f} kg where the robot weighs {robot.mass:.1f} kg"
        valid = "a standing robot, forces in N, masses in kg; 'contact: always' for sensors zeroed under load"
        raise DataError(f"{names}: {text} (valid: {valid})")
    size = max(log.size for log in logs)
    return_freed(size)  # what preparation took, copies of the process would keep
    told = newton_told(ready)
    ready, feet = (
        _with_imu_right(ready, progress) if told is None else _with_encoders_right(ready, told, progress)
    )
    fitted = with_shared_hysteresis(feet)
    between = between_all(list(fitted.values()))
    return_freed(size)  # likewise, the fits
    assessed = over_cores(lambda one: assess_foot(without_needless(one, between), between), fitted.values())
    found = without_soft_imu(assessed)
    ready = _merged(ready, {foot: one.ready for foot, one in fitted.items()})
    return feet_result(robot, ready, found, between, residuals)


def _with_encoders_right(
    ready: PreparedLogs, told: Late, progress: Callable[[str], None]
) -> tuple[PreparedLogs, dict[str, FittedFoot]]:
    """The logs and every foot fitted to them; again with encoders as late as fits of standing feet show them beside
    what Newton's law has `told`."""
    ready = read_at(ready, Late(tried_first(told), told.std))
    feet, taken = _fitted_feet(ready, progress), ready.sensor_delay.encoders
    shown = encoders_shown(feet, told, taken)
    if shown is None or not shown.is_worth(taken):
        return ready, feet
    progress("fit again with encoders read in time")
    ready = retold(read_at(ready, shown))
    return ready, _fitted_feet(ready, progress)


def _with_imu_right(
    ready: PreparedLogs, progress: Callable[[str], None]
) -> tuple[PreparedLogs, dict[str, FittedFoot]]:
    """The logs and every foot fitted to them; again with the IMU as its steps show it turned, where they do."""
    feet, mount = _fitted_feet(ready, progress), ready.robot.uncertainty.imu_mount
    for _ in range(TURN_ROUNDS):
        shown = turn_shown(feet, ready.imu_turn, mount)
        if shown is None or not is_worth(shown, ready.imu_turn):
            break
        progress("fit again with the IMU's turn put right")
        ready = put_right(ready, shown)
        feet = _fitted_feet(ready, progress)
    return ready, feet


def _fitted_feet(ready: PreparedLogs, progress: Callable[[str], None]) -> dict[str, FittedFoot]:
    """Every foot, those once more whose robot file another foot's motions put in doubt."""
    places = {foot: PlaceSpread.of(ready.robot, foot) for foot in ready.robot.feet}

    def fit_all(places: Mapping[str, PlaceSpread]) -> dict[str, FittedFoot]:
        for foot in places:
            progress(f"fit {foot}")
        found = over_cores(fit_foot, [ready] * len(places), places, places.values())
        return dict(zip(places, found, strict=True))

    found = fit_all(places)
    exact = {foot: one.elsewhere for foot, one in found.items() if one.elsewhere is not None}
    places |= {foot: as_measured(ready.robot, foot) for foot in exact}
    found |= fit_all({foot: places[foot] for foot in exact})
    fits = {foot: [*one.fits.values()] for foot, one in found.items()}
    wider = {
        foot: place.doubted_by([fit for other in fits if other != foot for fit in fits[other]], fits[foot])
        for foot, place in places.items()
    }
    found |= fit_all({foot: place for foot, place in wider.items() if place != places[foot]})
    return {foot: one.told(exact[foot]) if foot in exact else one for foot, one in found.items()}


def _merged(ready: PreparedLogs, by_foot: Mapping[str, PreparedLogs]) -> PreparedLogs:
    """The logs with each foot's contacts as its own fit left them."""
    fitted = tuple(
        replace(recording, contacts={foot: own.fitted[place].contacts[foot] for foot, own in by_foot.items()})
        for place, recording in enumerate(ready.fitted)
    )
    return replace(ready, fitted=fitted)
