"""What the moments' balance says of its own deviations, and of a log of which a part is used."""

from __future__ import annotations

import numpy as np
import pytest

from moments import fit_moments
from plantar.conventions import GRAVITY, Array
from plantar.feet.prepare_log import checked
from plantar.sensors.moments.law_rows import law_rows
from plantar.sensors.moments.moment_errors import PARTS, MomentErrors, RowProducts, row_products, weighed
from plantar.sensors.moments.moment_fit import solved
from plantar.sensors.moments.torque_gains import torque_gains
from plantar.sensors.newton_euler import newton_euler_residuals
from plantar.signals.filters import low_pass
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2
from twin_samples import planned_part, walked

COLUMNS, SAMPLES, PERIOD = 24, 400, 0.1  # as of a log of 40 s below 2 Hz
PRIOR = np.full(COLUMNS, 3.0)
NONE = np.zeros(0)


def swaying(random: np.random.Generator) -> Array:
    """Columns (k, n) of a robot that sways at three frequencies: mixtures of six signals and a little else."""
    time = PERIOD * np.arange(SAMPLES)
    tones = np.array(
        [wave(2 * np.pi * hertz * time) for hertz in (0.2, 0.33, 0.5) for wave in (np.sin, np.cos)]
    )
    slow = low_pass(random.normal(size=(SAMPLES, COLUMNS)), PERIOD, 1.0).T
    return random.normal(size=(COLUMNS, len(tones))) @ tones + 0.3 * slow


def log_of(columns: Array, missing: Array, zeros: Array = NONE) -> MomentErrors:
    """One row of Newton's law, the other five without a signal. zeros: deviations of those in the last columns."""
    both = np.concatenate([missing[None], columns])
    rows = np.array([both, *(np.zeros((5, *both.shape)) + 1e-9 * both)])
    products = np.array([part @ part.transpose(0, 2, 1) for part in np.array_split(rows, PARTS, axis=2)])
    rows = RowProducts(products.transpose(1, 0, 2, 3), products.sum(axis=0) / SAMPLES, 0.4, zeros)
    return weighed(rows, PRIOR)


def test_each_log_has_zeros_of_its_own() -> None:
    """What goes with the sway as a zero's moment does is no error that all logs share."""
    random, logs = np.random.default_rng(0), []
    for size in (5.0, 1.0):
        columns = swaying(random)
        zero = columns[0] + swaying(random)[0]
        noise = 0.01 * low_pass(random.normal(size=SAMPLES), PERIOD, 1.0)
        logs.append(log_of(np.vstack([columns, zero]), size * zero + noise, np.array([10.0])))
    assert abs(solved(logs, PRIOR)[0][0]) < 0.05


def test_what_a_wrong_urdf_does_is_told_from_sensors_errors_and_held_in_deviations() -> None:
    """All logs share a link that is as wrong as it may be, as they share a sensor's gain."""
    random = np.random.default_rng(0)
    columns = swaying(random)
    links = 0.7 * columns[:4] + swaying(random)[:4]
    told, without = [], []
    for _ in range(40):
        size = random.standard_normal(4)
        noise = 0.01 * low_pass(random.normal(size=(SAMPLES, 2)), PERIOD, 1.0).T
        logs = [log_of(np.vstack([columns, links]), size @ links + one) for one in noise]
        values, parts = solved(logs, PRIOR)
        told.append(values / np.sqrt(np.diag(sum(part.covariance for part in parts))))
        without.append([values[0], solved([log_of(columns, size @ links + noise[0])], PRIOR).values[0]])
    assert 0.3 < np.sqrt(np.mean(np.square(told))) < 1.3
    with_links, alone = np.sqrt(np.mean(np.square(without), axis=0))
    assert with_links < 0.5 * alone


def test_what_no_column_explains_counts_once_a_second() -> None:
    """Steps are alike: ten of them tell as much of what every landing adds as one."""
    robot, log = hrp2.robot(), checked(hrp2.robot(), walked())
    [residual] = newton_euler_residuals(robot, log)
    for steps, period in ((True, 0.05), (False, 0.1)):
        assert row_products(robot, residual, steps).share == pytest.approx(period, rel=1e-6)


def test_deviations_are_as_large_as_errors_where_many_columns_follow_few_frequencies() -> None:
    """What such columns leave of the noise at those frequencies is a fraction of it: deviations from it were halved."""
    random = np.random.default_rng(0)
    columns = swaying(random)
    told = []
    for _ in range(60):
        noise = low_pass(random.normal(size=SAMPLES), PERIOD, 1.0)
        values, parts = solved([log_of(columns, noise)], PRIOR)
        told.append(values / np.sqrt(np.diag(parts[0].covariance + parts[1].covariance)))
    assert 0.6 < np.sqrt(np.mean(np.square(told))) < 1.2


def test_a_log_in_which_a_hand_steadies_the_robot_says_little_beside_one_without() -> None:
    """A hand's moment goes with the sway, and passes for a gain where it counts as much as no hand does."""
    random = np.random.default_rng(0)
    alone, held = swaying(random), swaying(random)
    noise = [0.01 * low_pass(random.normal(size=SAMPLES), PERIOD, 1.0) for _ in range(2)]
    logs = [log_of(alone, noise[0]), log_of(held, noise[1] + 0.3 * held[0] + 0.3 * swaying(random)[0])]
    values, parts = solved(logs, PRIOR)
    assert abs(values[0]) < 0.01
    assert np.sqrt(sum(part.covariance[0, 0] for part in parts)) < 0.05


def test_what_encoders_shake_by_above_a_walks_steps_is_in_no_row() -> None:
    """Accelerations of coarse steps: they made torques of a robot that turns on the spot 7 % too large."""
    robot, log = hrp2.robot(), checked(hrp2.robot(), walked())
    name = "joint.LLEG_JOINT3.position"
    shaken = log.with_columns({name: log.column(name) + 1e-3 * np.sin(2 * np.pi * 6.5 * log.time)})
    missing = []
    for each in (log, shaken):
        [residual] = newton_euler_residuals(robot, each)
        missing.append(np.array([row.signals[:, 0] for row in law_rows(robot, residual, True)]))
    before, after = missing
    assert np.std(after - before) < 0.2 * np.std(before)


def test_a_walk_of_which_a_part_is_used_misses_what_its_columns_say() -> None:
    """Two per cent more torque adds two per cent of the torques' own columns, and nothing at the ends of the part."""
    robot, log = hrp2.robot(), checked(hrp2.robot(), walked())
    names = [name for name in log.columns if name.startswith("wrench.") and ".torque." in name]
    more = log.with_columns({name: 1.02 * log.column(name) for name in names})
    found = []
    for each in (log, more):
        [residual] = newton_euler_residuals(robot, each)
        assert residual.kept.stop - residual.kept.start < len(log)
        signals = [row.signals.T for row in law_rows(robot, residual, True)]
        found.append((residual.kept, np.array(signals)))
    (kept, before), (same, after) = found
    assert kept == same
    channels = [pair for pair in np.ndindex(6, 6) if pair[0] >= 3 or pair[1] < 3]
    own = 7 + len(channels)  # errors of one foot's sensor: gain, place, turn, channels
    singles = [4 + foot * own + 7 + channels.index((k, k)) for foot in range(2) for k in (3, 4, 5)]
    missing = before[:, 0] - after[:, 0]
    added = missing - 0.02 * before[:, 1:][:, singles].sum(axis=1)
    assert np.sqrt(np.mean(added**2)) < 0.02 * np.sqrt(np.mean(missing**2))


def test_steps_add_what_all_landings_share() -> None:
    robot, log = hrp2.robot(), checked(hrp2.robot(), walked())
    [residual] = newton_euler_residuals(robot, log)
    stood, stepped = (fit_moments(robot, [residual], names) for names in ((), (log.name,)))
    assert stood is not None
    assert stepped is not None
    assert len(stepped.parts) == len(stood.parts) + 1
    np.testing.assert_allclose(np.diag(stepped.parts[-1].covariance)[:5], [0.01**2] * 4 + [0.0])


@pytest.mark.parametrize("size", [0.005, 0.02])
def test_zeros_that_differ_between_recordings_are_no_gain_of_torques(size: float) -> None:
    """In a squat a force's zero makes a moment that goes with the squat. No error that all logs share explains it:
    half a per cent of the weight passed for torques that read twice too much."""
    robot, random = hrp2.robot(), np.random.default_rng(0)
    residuals = []
    for motion in ("Squat", "Tilt3"):
        log = checked(robot, play_all([planned_part(motion, robot)], robot, PAPER, "ideal", [0])[0][0].log)
        weight = size * robot.mass * GRAVITY
        zeros = {
            name: random.choice([-1, 1]) * weight * (0.1 if ".torque." in name else 1.0)
            for name in log.columns
            if name.startswith("wrench.")
        }
        columns = {name: log.column(name) + zero for name, zero in zeros.items()}
        residuals += newton_euler_residuals(robot, log.with_columns(columns))
    fit = fit_moments(robot, residuals, ())
    assert fit is not None
    # Of both feet together: both turn alike, and hardly anything tells one from the other.
    np.testing.assert_allclose(fit.values[:4].reshape(2, 2).mean(axis=1), 0.0, atol=0.03)
    assert torque_gains(robot, fit) == {}
