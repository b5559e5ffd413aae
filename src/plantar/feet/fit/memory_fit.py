"""A richer model fitted beside what changes with it: the bush's place, its centre in steps, the attitude's drift."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from plantar.feet.fit.angle_drift import beside_drift
from plantar.feet.fit.corrections import over_stances
from plantar.feet.fit.hidden_memory import has_memory
from plantar.feet.place.bush_place import about_its_place
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.load_torque import load_torque
from plantar.feet.regression.regression_data import data_set_of
from plantar.model_selection.data_sets import DataSet
from plantar.model_selection.model_fit import ModelFit, fit_again

CENTRE_ROUNDS = 2  # of finding memory and centre in turn


def standing(
    linear: AxisFit, fit: ModelFit, recordings: Sequence[Recording], place: PlaceSpread | None, shared: bool
) -> AxisFit:
    """A richer model of a standing foot, the bush's place and the angle's drift, found in turn: each changes with the
    others."""
    found = with_model(linear, fit)
    if place is not None:
        for _ in range(CENTRE_ROUNDS):
            moved = about_its_place(found, recordings, place, shared)
            fit = fit_again(fit, data_sets_about(recordings, moved))
            linear = placed_as(linear, moved)
            found = with_model(linear, fit)
    if shared or not has_memory(fit.model):
        return found

    def again(drifted: AxisFit) -> AxisFit:
        nonlocal fit
        fit = fit_again(fit, data_sets_about(recordings, drifted))
        return with_model(drifted, fit)

    return beside_drift(found, recordings, again)


def about_its_centre(
    linear: AxisFit, fit: ModelFit, recordings: Sequence[Recording], share: float
) -> AxisFit:
    """A fit of stances whose memory is found about the bush's centre; where that is, the linear parameters tell.

    As soon as they do, other slip angles are tried: about a wrong centre a wrong one may fit best.
    """
    found = over_stances(with_model(linear, fit), recordings)
    for turn in range(CENTRE_ROUNDS):
        place = found.place[1:]
        data_sets = [data_set_of(each, linear.foot, linear.axis, share, *place) for each in recordings]
        fit = fit_again(fit, data_sets, elsewhere=turn == 0)
        found = over_stances(with_model(linear, fit), recordings)
    return found


def data_sets_about(recordings: Sequence[Recording], fit: AxisFit) -> list[DataSet]:
    """The data sets with the IMU's turn put right, and without the torque that a fit found not to be the bush's; a path
    for a memory without the drift that it found."""
    found = []
    for recording in recordings:
        data_set = data_set_of(
            recording, fit.foot, fit.axis, imu_turned=fit.imu_turned, drift=fit.drifts.get(recording.name)
        )
        found.append(replace(data_set, torque=data_set.torque - load_torque(recording, fit)))
    return found


def placed_as(fit: AxisFit, other: AxisFit) -> AxisFit:
    """A fit about the place that another one found."""
    return replace(fit, moment_arms=other.moment_arms, turned=other.turned, imu_turned=other.imu_turned)


def with_model(linear: AxisFit, fit: ModelFit) -> AxisFit:
    """The fit of a richer model in place of the linear one, whose stiffness and damping stay as its equivalent."""
    return replace(
        linear,
        model=fit.model,
        values=fit.values,
        shape=fit.shape,
        offsets=fit.offsets,
        initial_states=fit.initial_states,
        covariance=fit.covariance,
        freedom=fit.freedom,
        white_std=fit.white_std,
        offset_std=fit.offset_std,
    )
