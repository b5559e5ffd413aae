"""What a result holds of a foot: each axis of its fit widened, scored, judged and diagnosed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.feet.assess.contradiction import contradiction
from plantar.feet.assess.data_faults import OF_MOMENTS, data_faults, doubted
from plantar.feet.assess.diagnosis import advised, diagnose_axis, mend_first, untimed
from plantar.feet.assess.late_recordings import RECORDING_LATE, late_recordings
from plantar.feet.assess.left_out import ON_AN_EDGE, mostly_on_an_edge
from plantar.feet.assess.odd_recordings import odd_recordings, odd_walks
from plantar.feet.assess.parameter_rows import axis_rows, missing_rows, unseen_rows
from plantar.feet.assess.play import Play, find_play, play_notes
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.assess.scores import score_axis
from plantar.feet.assess.sensor_hysteresis import hysteresis_notes
from plantar.feet.assess.stance_stiffness import stance_stiffness, walk_stiffness
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.internal_error import gives_up, internal_errors
from plantar.feet.interval_width.between_recordings import Apart
from plantar.feet.interval_width.cause import inflated
from plantar.feet.interval_width.force_gain import force_gain_causes, force_gain_notes, torque_gain_causes
from plantar.feet.interval_width.joint_compliance import joint_compliance_causes
from plantar.feet.interval_width.sensor_causes import encoder_delay_causes, fading_causes, imu_turn_causes
from plantar.feet.interval_width.slip_angle import slip_angle_causes
from plantar.feet.interval_width.systematic import robot_causes, systematic_causes
from plantar.feet.place.misread_joints import IMU_SOFT, OUT_OF_TIME, misread_joint_notes
from plantar.feet.place.place_notes import far_arms
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import recordings_of
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note
from plantar.results.feet import Diagnosis, Parameter, ValidationRow
from plantar.results.walk_rows import StanceStiffness, WalkStiffness
from plantar.robot.guesses import naming_notes
from plantar.sensors.attitude_scale import ATTITUDE_SCALE
from plantar.sensors.moments.torque_gains import torque_gain_notes


@dataclass(frozen=True)
class FootFit:
    """What a result holds of one foot: of each axis that could be fitted, and rows that say why one could not."""

    fits: list[AxisFit] = field(default_factory=list)
    parameters: list[Parameter] = field(default_factory=list)
    validation: list[ValidationRow] = field(default_factory=list)
    diagnosis: list[Diagnosis] = field(default_factory=list)
    predictions: Predictions = field(default_factory=dict)
    stances: list[StanceStiffness] = field(default_factory=list)
    walks: list[WalkStiffness] = field(default_factory=list)
    notes: tuple[Note, ...] = ()


def assess_foot(fitted: FittedFoot, between: Apart) -> FootFit:
    """Each axis of a fitted foot widened, scored, judged and diagnosed, or why it is given up. between: what all axes
    show recordings to differ by."""
    edges = mostly_on_an_edge(fitted.foot, fitted.ready.robot.feet[fitted.foot], fitted.ready.fitted)
    found, plays = FootFit(notes=(*edges, *fitted.jumps)), _plays(fitted)
    for axis in ROTATIONAL_AXES:
        if axis in fitted.fits and axis not in fitted.given_up:
            with gives_up(axis, fitted.given_up):
                others = [play for at, play in plays.items() if at != axis]
                found = _with_axis(found, fitted, fitted.fits[axis], between, *others)
        if axis in fitted.given_up:
            found.parameters.extend(missing_rows(fitted.foot, axis, fitted.given_up[axis]))
        elif axis not in fitted.fits:
            found.parameters.extend(unseen_rows(fitted.foot, axis, fitted.ready.fitted))
    # A clock that is late is late about both axes, also about the one that hardly shows it.
    late = [note for note in found.notes if note.code in (RECORDING_LATE, OUT_OF_TIME)]
    notes = (*found.notes, *internal_errors(fitted.foot, fitted.given_up))
    return replace(found, parameters=doubted(found.parameters, late), notes=notes)


def without_soft_imu(feet: Sequence[FootFit]) -> list[FootFit]:
    """The feet, none of whose numbers is usable where one shows that the IMU of all leans in its mount."""
    soft = [note for one in feet for note in one.notes if note.code == IMU_SOFT]
    return [replace(one, parameters=doubted(one.parameters, soft)) for one in feet]


def _plays(fitted: FittedFoot) -> dict[Axis, Play]:
    """The axes of a foot that surely play, each with its play."""
    plays = dict[Axis, Play]()
    for axis, fit in fitted.fits.items():
        if axis not in fitted.given_up:
            with gives_up(axis, fitted.given_up):
                tangent = Tangent.of(fit, fitted.thin.fitted, fitted.ready.settings.shared)
                play = find_play(tangent)
                if play is not None and play.surely(tangent):
                    plays[axis] = play
    return plays


def _with_axis(
    found: FootFit, fitted: FittedFoot, fit: AxisFit, between: Apart, other: Play | None = None
) -> FootFit:
    """What was found, and one axis: its fit widened, scored, judged and diagnosed. other: the other axis' play."""
    ready, thin = fitted.ready, fitted.thin
    tangent = Tangent.of(fit, thin.fitted, ready.settings.shared)
    with_logs = replace(tangent, recordings=recordings_of(tangent.blocks, ready.fitted))
    causes = systematic_causes(tangent, ready.sensor_delay, ready.vertical)
    causes += robot_causes(tangent, ready.robot.uncertainty.wrench_gain, between)
    causes += slip_angle_causes(tangent)
    causes += encoder_delay_causes(tangent, ready.sensor_delay.encoders_std)
    causes += joint_compliance_causes(ready.robot, with_logs, ready.bending)
    causes += fading_causes(tangent, ready.slow_filter)
    causes += imu_turn_causes(tangent, ready.imu_turn)
    causes += force_gain_causes(fit, ready.gain_errors)
    causes += torque_gain_causes(fit, ready.torque_gains)
    wide = inflated(fit, causes)
    scores, predictions = score_axis(ready.recordings, wide)
    contradicted = contradiction(
        scores, wide, ready.recordings, predictions, ready.robot.uncertainty.imu_mount
    )
    rows = untimed(axis_rows(wide, ready.fitted, predictions, contradicted), ready.sensor_delay.note)
    limits = diagnose_axis(fit, wide, causes, rows)
    gain = {foot: error for foot, error in ready.gain_errors.items() if foot == fit.foot}
    walks = walk_stiffness(ready.recordings, wide)
    own = [
        *play_notes(tangent, wide, other),
        *hysteresis_notes(tangent, wide),
        *misread_joint_notes(ready.robot, with_logs, wide),
        *late_recordings(tangent, wide),
        *odd_recordings(tangent, wide),
        *odd_walks(tangent, wide, walks),
    ]
    faults = [
        *data_faults(ready.fitted, fit),
        *fitted.jumps,  # of both axes: an encoder that slips about one tilts the other as well
        *own,
        *force_gain_notes(ready.robot, gain),
        # Torque channels that are wrong about one axis are trusted about neither.
        *(note for note in torque_gain_notes(ready.torque_gains).values() if note.severity == "warning"),
        *naming_notes(ready.robot.path.name, ready.robot.guesses),
        *(note for foot, note in ready.turned.items() if foot == fit.foot),
        *(note for note in ready.notes if note.code in (*OF_MOMENTS, ATTITUDE_SCALE)),
    ]
    # Behind the others: a mass, a gain or a delay that is wrong looks like one. Steps hardly tell how far a bush is.
    # Bush and sensor have one height: what is far about one axis is trusted about neither.
    far = far_arms([*fitted.fits.values()]) if fitted.place.measured and not tangent.steps else []
    # What is left of a foot on its edge is flat, and no number is doubted; what most of it could tell comes first.
    first = [*(note for note in found.notes if note.code == ON_AN_EDGE), *(faults or far)]
    return FootFit(
        fits=[*found.fits, wide],
        parameters=[
            *found.parameters,
            *mend_first(doubted(advised(rows, limits), [*faults, *far], steps=tangent.steps), first),
        ],
        validation=[*found.validation, *scores],
        diagnosis=[*found.diagnosis, *limits],
        predictions={**found.predictions, **predictions},
        stances=[*found.stances, *stance_stiffness(ready.recordings, wide)],
        walks=[*found.walks, *walks],
        notes=(*found.notes, *own),
    )
