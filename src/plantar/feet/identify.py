"""Stiffness, damping and offset of each foot from what the robot recorded (paper, sections 3 and 4)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from plantar.conventions import OFFSET_UNIT
from plantar.errors import DataError
from plantar.feet.assess.far_arms import far_arms
from plantar.feet.assess.feasible_advice import hardly_standing, remedies, with_remedies
from plantar.feet.assess.left_out import unused_logs
from plantar.feet.assess.residual_table import residual_table
from plantar.feet.first_look import over_logs
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.bush_place import PlaceSpread
from plantar.feet.fit.imu_mount import ImuTurn
from plantar.feet.foot_fit import FittedFoot, assess_foot, between_all, fit_foot, without_needless
from plantar.feet.imu_of_steps import imu_turn_notes, is_worth, put_right, turn_shown
from plantar.feet.interval_width.between_recordings import apart_notes
from plantar.feet.memory_of_others import with_memory_of_others
from plantar.feet.prepare import PreparedLogs, prepare_all
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.logs.freed_memory import return_freed
from plantar.logs.inputs import LogInputs, RobotInput, logs_of, robot_of
from plantar.models import KelvinVoigt
from plantar.notes import Note, joined
from plantar.results.feet import AxisModel, DelayEstimate, FeetResult, Input, Offset
from plantar.results.feet_rows import Candidate, LinearEquivalent
from plantar.robot.model import Foot, Placement, RobotModel
from plantar.sensors.delays.sensor_delay import SensorDelay

TURN_ROUNDS = 2  # of fitting again with the IMU's turn: what a fit took up of it before shows in the next


def identify_feet(
    robot: RobotInput,
    logs: LogInputs,
    validate: LogInputs = (),
    settings: FeetSettings | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> FeetResult:
    """Stiffness, damping and offset of each foot, in pitch and roll, from logs of a standing robot (eq. 4 to 7).

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
        robot, logs_of(logs, robot), logs_of(validate, robot), settings or FeetSettings(), progress
    )
    return fit_prepared(robot, ready, progress)


def fit_prepared(
    robot: RobotModel, ready: PreparedLogs, progress: Callable[[str], None] = lambda _: None
) -> FeetResult:
    """`identify_feet` on logs that are ready. Raises DataError where no foot carries load in any of them."""
    logs = [recording.log for recording in ready.fitted]
    if not any(recording.contacts[foot].standing.any() for recording in ready.fitted for foot in robot.feet):
        names = ", ".join(log.name for log in logs)
        valid = "a standing robot; were the sensors zeroed under load, 'contact: always' for these feet"
        raise DataError(f"{names}: no foot carries load in any log (valid: {valid})")
    return_freed()  # what preparation took, copies of the process would keep
    ready, feet = _with_imu_right(ready, progress)
    fitted = with_memory_of_others(feet)
    between = between_all(list(fitted.values()))
    fitted = {foot: without_needless(one) for foot, one in fitted.items()}
    with over_logs([recording.log for recording in ready.recordings]) as each:
        found = list(each(assess_foot, fitted.values()))
    ready = _merged(ready, {foot: one.ready for foot, one in fitted.items()})
    fits = [fit for each in found for fit in each.fits]
    limits = [row for each in found for row in each.diagnosis]
    feasible = remedies(ready.settings, ready.sensor_delay, robot, ready.fitted)
    parameters, limits = with_remedies([row for each in found for row in each.parameters], limits, feasible)
    rows = [row for each in found for row in each.validation]
    predictions = {key: value for each in found for key, value in each.predictions.items()}
    return FeetResult(
        robot=robot.name,
        inputs=tuple(Input.of(recording.log, recording.role) for recording in ready.recordings),
        settings=ready.settings.to_dict(),
        model=_model(fits),
        parameters=(*parameters, *hardly_standing(ready.vertical.parameters, ready.fitted)),
        offsets=tuple(offset for fit in fits for offset in _offsets(fit)),
        phases=tuple(
            phase
            for recording in ready.recordings
            for foot, contact in recording.contacts.items()
            for phase in contact.phases(recording.name, foot, recording.time)
        ),
        validation=tuple(sorted(rows, key=lambda row: row.kind != "direct")),
        notes=joined(
            [
                *ready.notes,
                *imu_turn_notes(ready.imu_turn, robot.uncertainty.imu_mount),
                *_feet_notes(robot, ready.fitted),
                *unused_logs(ready.fitted),
                *_model_notes(fits),
                *apart_notes(between),
                *(note for each in found for note in each.notes),
            ],
            [recording.name for recording in ready.recordings],
        ),
        robot_model=_robot_model(robot),
        models=tuple(_axis_model(fit, ready.imu_turn) for fit in fits),
        sensor_delay=delay_estimate(ready.sensor_delay),
        compliance=dict(ready.vertical.compliance),
        diagnosis=tuple(limits),
        stances=tuple(row for each in found for row in each.stances),
        walks=tuple(row for each in found for row in each.walks),
        swing_zeros=tuple(row for recording in ready.recordings for row in recording.zeros),
        residuals=residual_table(ready.recordings, predictions),
    )


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
        with over_logs([recording.log for recording in ready.recordings]) as each:
            for foot in places:
                progress(f"fit {foot}")
            found = each(fit_foot, [ready] * len(places), places, places.values())
            return dict(zip(places, found, strict=True))

    found = fit_all(places)
    fits = {foot: [*one.fits.values()] for foot, one in found.items()}
    wider = {
        foot: place.doubted_by([fit for other in fits if other != foot for fit in fits[other]], fits[foot])
        for foot, place in places.items()
    }
    return found | fit_all({foot: place for foot, place in wider.items() if place != places[foot]})


def _axis_model(fit: AxisFit, turn: ImuTurn) -> AxisModel:
    """The model of one axis, why it was chosen, and what the others missed by on held-out motions."""
    x, y, z = (np.array(fit.imu_turned) + turn.angles).tolist()  # in all, beside the logs as they were
    linear = LinearEquivalent(*fit.equivalent)
    axis_model = AxisModel(
        fit.foot,
        fit.axis,
        fit.model.name,
        fit.reason,
        linear,
        fit.moment_arms,
        turned=fit.turned,
        leans=fit.leans,
        imu_turned=(x, y, z),
    )
    if fit.choice is None:
        return axis_model
    ranking = tuple(
        Candidate(tried.model.name, tried.held_out_rms, tried.parameters, tried.refused, tried.chosen)
        for tried in fit.choice.ranking
    )
    return replace(axis_model, held_out=fit.choice.held_out, ranking=ranking)


def delay_estimate(found: SensorDelay) -> DelayEstimate:
    """The delays that the logs were corrected for."""
    return DelayEstimate(
        found.delay, found.std, found.measured, feet=dict(found.feet), encoder_delay=found.encoders
    )


def _merged(ready: PreparedLogs, by_foot: Mapping[str, PreparedLogs]) -> PreparedLogs:
    """The logs with each foot's contacts as its own fit left them."""
    fitted = tuple(
        replace(recording, contacts={foot: own.fitted[place].contacts[foot] for foot, own in by_foot.items()})
        for place, recording in enumerate(ready.fitted)
    )
    return replace(ready, fitted=fitted)


def _model(fits: Sequence[AxisFit]) -> str:
    """The model of most axes; of equally many, the richer one."""
    counts = Counter(fit.model.name for fit in fits)
    return max(counts, key=lambda name: (counts[name], name != KelvinVoigt.name), default=KelvinVoigt.name)


def _model_notes(fits: Sequence[AxisFit]) -> list[Note]:
    """Models richer than spring and damper, and what a chosen model leaves open."""
    notes, cautions = [], dict[str, list[str]]()
    for fit in fits:
        where = f"{fit.foot} {fit.axis}"
        if fit.model.name != KelvinVoigt.name:
            stiffness, damping = fit.equivalent
            linear = f"the nearest spring and damper has K = {stiffness:.4g}, C = {damping:.4g}"
            text = f"{where}: the model is {fit.model.name}: {fit.reason}; {linear}"
            notes.append(Note("model", "info", text))
        if fit.choice is not None and fit.choice.caution is not None:
            cautions.setdefault(fit.choice.caution, []).append(where)
        notes += fit.notes
    told = [
        Note("model_caution", "warning", f"{', '.join(where)}: {text}") for text, where in cautions.items()
    ]
    return [*notes, *told, *far_arms([fit for fit in fits if not fit.notes])]


def _offsets(fit: AxisFit) -> list[Offset]:
    unit = OFFSET_UNIT[fit.axis]
    return [
        Offset(fit.foot, fit.axis, motion, unit, value, fit.offset_std[motion])
        for motion, value in fit.offsets.items()
    ]


def _feet_notes(robot: RobotModel, recordings: Sequence[Recording]) -> list[Note]:
    notes = []
    for foot in robot.feet:
        if not any(recording.contacts[foot].standing.any() for recording in recordings):
            notes.append(Note("foot_never_stands", "warning", f"the {foot} foot carries no load in any log"))
    double = any(
        np.any(contact.support == 0) for recording in recordings for contact in recording.contacts.values()
    )
    if len(robot.feet) > 1 and not double:
        notes.append(
            Note("no_double_support", "info", "no log has both feet on the ground: slip cannot be checked")
        )
    return notes


def _robot_model(robot: RobotModel) -> dict[str, Any]:
    """What an export needs of the robot: its URDF's path, each foot's geometry, and what its file may be off by."""

    def placed(placement: Placement) -> dict[str, Any]:
        return {"link": placement.link, "xyz": placement.xyz.tolist(), "rpy": placement.rpy.tolist()}

    def described(foot: Foot) -> dict[str, Any]:
        sole = {**placed(foot.sole.placement), "polygon": foot.sole.polygon.tolist()}
        return {"ankle": foot.ankle, "bush": placed(foot.bush), "sole": sole}

    return {
        "urdf": str(robot.urdf_path),
        "feet": {name: described(foot) for name, foot in robot.feet.items()},
        "uncertainty": robot.uncertainty.model_dump(),
    }
