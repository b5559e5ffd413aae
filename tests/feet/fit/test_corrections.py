"""A cube about a wrong zero of the deflection: the attitude's bias is another in each recording."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import TRUTH, record, sway
from biped_robot import FEET
from feet_trials import AXES, PUNCTUAL, noisy
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.stances import Stances
from plantar.estimation import fit_blocks
from plantar.feet.fit.corrections import about_true_zero, over_stances, unattenuated
from plantar.feet.identify import identify_feet
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import blocks_of
from plantar.logs.motion_log import MotionLog
from plantar.models import MODELS, KelvinVoigt
from plantar.robot.model import RobotModel

HARDENING = 30000.0  # N·m/rad³


def leaning(log: MotionLog, angle: float) -> MotionLog:
    """The log of an IMU that believes itself pitched by `angle` [rad], and rolled by a part of it."""
    orientation = log.orientation("chest")
    assert orientation is not None
    believed = Rotation.from_rotvec([0.4 * angle, angle, 0]) * Rotation.from_quat(
        orientation, scalar_first=True
    )
    quaternions = believed.as_quat(scalar_first=True)
    return log.with_columns(
        {f"imu.chest.orientation.{axis}": quaternions[:, place] for place, axis in enumerate("wxyz")}
    )


def test_a_cube_is_found_about_its_own_zero(robot: RobotModel) -> None:
    """Taken about the recorded zero, it would come out half as large in pitch."""
    truth = {key: replace(law, hardening=HARDENING) for key, law in TRUTH.items()}
    motions = [sway(f"sway_{seed}", seed, duration=40.0, truth=truth) for seed in (3, 4)]
    logs = [
        leaning(noisy(record(motion), 1), bias) for motion, bias in zip(motions, (0.01, -0.006), strict=True)
    ]
    found = identify_feet(robot, logs, settings=replace(PUNCTUAL, model="hardening_elastoplastic"))
    for foot in FEET:
        for axis in AXES:
            assert found.parameter(foot, axis, "hardening").value == pytest.approx(HARDENING, rel=0.1)
            stiffness = found.parameter(foot, axis, "stiffness").value
            assert stiffness == pytest.approx(TRUTH[foot, axis].stiffness, rel=0.02)


def noisy_angles(size: float, middle: float = 0.0) -> tuple[list[Recording], AxisFit]:
    """A sway about `middle` [rad] whose angle and rate are read with white noise of `size` [rad] and ten times that
    [rad/s]; its fit. The bush's torque has no offset."""
    random, angle = np.random.default_rng(0), middle + swayed(6000)
    rate = np.gradient(angle, PERIOD)
    torque = 400.0 * angle + 20.0 * rate
    read = made_recording(
        "sway",
        angle + size * random.standard_normal(6000),
        torque,
        rate=rate + 10 * size * random.standard_normal(6000),
    )
    noise = np.array([[1.0], [100.0]]) * size**2 * np.ones((2, 2))
    read = replace(read, noise={FOOT: noise})
    blocks = blocks_of([read], FOOT, "pitch")
    found = fit_blocks(blocks)
    fit = AxisFit(
        foot=FOOT, axis="pitch", model=KelvinVoigt(), values=found.values, shape=np.zeros(0), offsets=found.offsets,
        covariance=found.covariance[:2, :2], freedom=found.freedom[:2], white_std=found.white_std,
        offset_std={"sway": 0.1}, equivalent=(float(found.values[0]), float(found.values[1])), choice=None, reason="",
    )  # fmt: skip
    return [read], fit


def test_what_noise_in_the_angles_takes_off_is_given_back_and_widens() -> None:
    recordings, fit = noisy_angles(0.004)
    assert fit.values[0] < 390.0
    right = unattenuated(fit, recordings, shared=False)
    assert right.values == pytest.approx([400.0, 20.0], rel=0.03)
    assert right.equivalent == pytest.approx(right.values)
    taken = right.values - fit.values
    added = right.covariance - fit.covariance
    np.testing.assert_allclose(
        added[:2, :2], 0.3**2 * np.outer(taken, taken), rtol=1e-6
    )  # it may not be white
    for name, part in zip(("stiffness", "damping"), 100 * taken / fit.values, strict=True):
        assert f"{name} {part:+.2g} %" in right.notes[0].text
    assert [(note.code, note.severity) for note in right.notes] == [("noisy_regressors", "info")]


def test_the_offset_follows_what_noise_had_taken_off_the_stiffness() -> None:
    """A spring that is too soft needs a constant to reach the torque about the middle of the sway."""
    recordings, fit = noisy_angles(0.004, middle=0.05)
    assert fit.offsets["sway"] > 0.5
    right = unattenuated(fit, recordings, shared=False)
    assert abs(right.offsets["sway"]) < 0.2 * fit.offsets["sway"]
    assert right.offset_std["sway"] > fit.offset_std["sway"]


def test_a_clean_angle_is_left_alone_and_one_of_mostly_noise_is_told() -> None:
    recordings, fit = noisy_angles(1e-5)
    assert unattenuated(fit, recordings, shared=False) is fit
    # However sure the numbers are: a thousandth of them is little.
    for size, left in ((1e-4, True), (3e-3, False)):
        recordings, fit = noisy_angles(size)
        fit = replace(fit, covariance=1e-12 * np.eye(2))
        assert (unattenuated(fit, recordings, shared=False) is fit) == left
    recordings, fit = noisy_angles(0.1)
    (note,) = unattenuated(fit, recordings, shared=False).notes
    assert (note.code, note.severity) == ("noisy_regressors", "warning")


def test_a_zero_matters_to_a_cube_alone() -> None:
    recordings, fit = noisy_angles(1e-5)
    assert about_true_zero(fit, recordings, shared=False) is fit


def test_stances_tell_how_well_a_number_is_known_where_they_know_less() -> None:
    """Deviations are the larger ones of both fits, each with its own degrees of freedom."""
    count, random = 6000, np.random.default_rng(1)
    number = np.repeat(np.arange(12), count // 12)
    angle = swayed(count)
    torque = (
        400.0 * angle + random.normal(0, 2.0, 12)[number] + 0.5 * np.cumsum(random.normal(0, 0.05, count))
    )
    recording = made_recording("walk", angle, torque, stances=Stances(number, np.ones(count)))
    state = recording.bushes[FOOT]
    state = replace(state, torque=np.column_stack([torque, 50.0 * swayed(count, seed=5)]))
    recording = replace(recording, bushes={FOOT: state}, raw={FOOT: state})
    found = fit_blocks(blocks_of([recording], FOOT, "pitch"))
    for size, kept in ((1e4, True), (1e-12, False)):
        fit = AxisFit(
            foot=FOOT, axis="pitch", model=KelvinVoigt(), values=np.array([400.0, 0.0]), shape=np.zeros(0),
            offsets={"walk": 0.0}, covariance=size * np.eye(2), freedom=np.full(2, 99.0), white_std=np.ones(2),
            offset_std={"walk": 0.1}, equivalent=(400.0, 0.0), choice=None, reason="",
        )  # fmt: skip
        moved = over_stances(fit, [recording])
        assert moved.values == pytest.approx(found.values)
        assert moved.std == pytest.approx(fit.std if kept else found.std[:2])
        assert moved.freedom == pytest.approx(fit.freedom if kept else found.freedom[:2])
        assert found.freedom[0] == 11.0, "one less than there are stances"


def test_an_offset_about_an_unknown_zero_is_no_better_known() -> None:
    """Of two fits the larger deviation counts, for the offset as for the values."""
    angle = swayed(6000)
    noise = np.random.default_rng(0).normal(0, 0.5, 6000)
    recording = made_recording("sway", angle, 400.0 * angle + 3e4 * angle**3 + noise)
    model = MODELS["hardening_elastoplastic"]
    known = {"stiffness": 400.0, "hardening": 3e4}
    fit = AxisFit(
        foot=FOOT, axis="pitch", model=model, values=np.array([known.get(term, 0.0) for term in model.terms]),
        shape=np.array([0.01]), offsets={"sway": 0.0}, covariance=np.eye(5), freedom=np.full(5, 20.0),
        white_std=np.ones(5), offset_std={"sway": 1e-9}, equivalent=(400.0, 0.0), choice=None, reason="",
    )  # fmt: skip
    assert about_true_zero(fit, [recording], shared=False).offset_std["sway"] > 1e-4
    sure = about_true_zero(replace(fit, offset_std={"sway": 5.0}), [recording], shared=False)
    assert sure.offset_std["sway"] == 5.0


def test_a_correction_worth_it_is_a_tenth_of_a_deviation_and_a_thousandth_of_a_value() -> None:
    """One of both numbers is enough; the spring and damper nearest to a richer model stay what they are."""
    recordings, fit = noisy_angles(0.004)
    taken = unattenuated(fit, recordings, shared=False).values - fit.values
    for share, left in ((0.98, False), (1.02, True)):
        wide = replace(fit, covariance=np.diag((share * np.abs(taken) / 0.1) ** 2))
        assert (unattenuated(wide, recordings, shared=False) is wide) == left
    moved = unattenuated(fit, recordings, shared=False)
    own = moved.offsets["sway"] - fit.offsets["sway"]
    assert moved.offset_std["sway"] == pytest.approx(np.hypot(0.1, 0.3 * own))
    richer = replace(
        fit, model=MODELS["elastoplastic"], values=np.append(fit.values, 1.0), shape=np.array([0.01]),
        covariance=1e-6 * np.eye(4), equivalent=(123.0, 4.0),
    )  # fmt: skip
    assert unattenuated(richer, recordings, shared=False).equivalent == (123.0, 4.0)
