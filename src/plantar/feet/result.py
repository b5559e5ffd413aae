"""The result of a fit: what was found of every foot, as rows and notes that a file holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from plantar.conventions import OFFSET_UNIT
from plantar.feet.assess.data_faults import doubted, standing_faults
from plantar.feet.assess.feasible_advice import hardly_standing, remedies, with_remedies
from plantar.feet.assess.left_out import unused_logs
from plantar.feet.assess.residual_table import residual_table
from plantar.feet.assumptions import assumptions
from plantar.feet.fit.compliances import share_apart
from plantar.feet.foot_assessment import FootFit
from plantar.feet.interval_width.between_recordings import Apart, apart_notes
from plantar.feet.place.imu_mount import ImuTurn
from plantar.feet.place.place_notes import far_arms
from plantar.feet.prepare import PreparedLogs
from plantar.feet.put_right.imu_of_steps import imu_turn_notes
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt
from plantar.notes import Note, joined
from plantar.results.feet import AxisModel, DelayEstimate, FeetResult, Input, Offset
from plantar.results.feet_rows import Candidate, LinearEquivalent
from plantar.robot.model import Foot, Placement, RobotModel
from plantar.sensors.delays.sensor_delay import SensorDelay


def feet_result(
    robot: RobotModel, ready: PreparedLogs, found: Sequence[FootFit], between: Apart, residuals: bool
) -> FeetResult:
    """Everything that is known of a robot's feet from logs that are ready, each of which was fitted and assessed as
    one of `found`; `between`: by how much its recordings differ; `residuals`: whether they are asked for."""
    fits = [fit for each in found for fit in each.fits]
    limits = [row for each in found for row in each.diagnosis]
    feasible = remedies(ready.settings, ready.sensor_delay, robot, ready.fitted)
    parameters, limits = with_remedies([row for each in found for row in each.parameters], limits, feasible)
    heights = ready.vertical.of_feet_that_differ(share_apart(parameters))
    vertical = doubted(hardly_standing(heights.parameters, ready.fitted), standing_faults(ready.fitted))
    rows = [row for each in found for row in each.validation]
    predictions = {key: value for each in found for key, value in each.predictions.items()}
    return FeetResult(
        robot=robot.name,
        inputs=tuple(Input.of(recording.log, recording.role) for recording in ready.recordings),
        settings=ready.settings.to_dict(),
        model=_model(fits),
        parameters=(*parameters, *vertical),
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
        joint_compliance=ready.bending.by_joint(robot),
        diagnosis=tuple(limits),
        assumptions=assumptions(ready, found, between),
        stances=tuple(row for each in found for row in each.stances),
        walks=tuple(row for each in found for row in each.walks),
        swing_zeros=tuple(row for recording in ready.recordings for row in recording.zeros),
        residuals=residual_table(ready.recordings, predictions) if residuals else None,
    )


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
        crosstalk=fit.crosstalk,
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
        "uncertainty": asdict(robot.uncertainty),
    }
