"""What hangs below a force sensor is found from a swinging foot, and from a standing one nothing is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import GRAVITY
from plantar.dynamics import Equation
from plantar.dynamics.motion import Motion, pinocchio_motion
from plantar.feet.prepare_log import checked
from plantar.robot.model import RobotModel
from plantar.sensors.below_sensor import _as_plate, below_sensors, counts_below
from plantar.sensors.newton_euler import newton_euler_residuals
from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.urdf import urdf_text
from twin_samples import walked

PERIOD, COUNT = 0.025, 800
TIME = PERIOD * np.arange(COUNT)
ZERO = np.array([3.0, -2.0, 5.0, 0.2, -0.1, 0.3])


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    return hrp2.robot()


def moved(robot: RobotModel, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, v and a of every joint and of the pelvis about one posture, sums of sines, `size` [rad]."""
    model, random = robot.floating_model, np.random.default_rng(0)
    frequency, phase = 2 * np.pi * random.uniform(0.5, 1.5, model.nv), random.uniform(0, 6, model.nv)
    angle = frequency * TIME[:, None] + phase
    amplitude = np.append(np.zeros(6), np.full(model.nv - 6, size))
    v, a = amplitude * frequency * np.cos(angle), -amplitude * frequency**2 * np.sin(angle)
    neutral = pin.neutral(model)
    q = np.array([pin.integrate(model, neutral, row) for row in amplitude * np.sin(angle)])
    return q, v, a


def readings(
    robot: RobotModel, motion: tuple[np.ndarray, np.ndarray, np.ndarray], part: pin.Inertia
) -> np.ndarray:
    """What both sensors read by Pinocchio's accelerations of their links, with `part` below each; the feet step."""
    model, data, rows = robot.floating_model, robot.floating_model.createData(), []
    frames = [robot.frame(foot.wrench.placement) for foot in robot.feet.values()]
    for sample, (q, v, a) in enumerate(zip(*motion, strict=True)):
        pin.rnea(model, data, q, v, a)
        row = []
        for foot, (carrier, placement) in enumerate(frames):
            rate, acceleration = data.v[carrier + 1], data.a_gf[carrier + 1]
            hanging = placement.actInv(part * acceleration + part.vxiv(rate)).vector
            stands = (TIME[sample] // 0.8) % 2 == foot
            since = TIME[sample] % 0.8
            # A low-pass smears what the foot carried, or will carry.
            smeared = 20.0 if min(since, 0.8 - since) < 0.1 and 0.1 < TIME[sample] < TIME[-1] - 0.1 else 0.0
            ground = np.array([0, 0, 500.0 if stands else smeared, 0, 0, 0])
            row.append(ground + ZERO - hanging)
        rows.append(np.concatenate(row))
    return np.array(rows)


def found(
    robot: RobotModel, size: float, noise: float = 0.0, load_zero: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """The parameters found of each foot's part, (feet, 10), and the part's own (10,)."""
    part = pin.Inertia(0.7, np.array([0.03, 0.01, -0.08]), np.diag([0.003, 0.004, 0.002]))
    motion, equation = moved(robot, size), Equation(robot.floating_model)
    read = readings(robot, motion, part)
    read += noise * np.random.default_rng(1).standard_normal(read.shape)
    read[:, [2, 8]] += load_zero
    rates: Motion = pinocchio_motion(robot.floating_model, equation.tree, *motion)
    below = below_sensors(robot, equation, rates, read, PERIOD).parameters.reshape(-1, 10)
    links = [robot.frame(foot.wrench.placement)[0] for foot in robot.feet.values()]
    assert not np.delete(below, links, axis=0).any()
    return below[links], part.toDynamicParameters()


def test_a_swinging_foot_shows_what_hangs_below_its_sensor(robot: RobotModel) -> None:
    below, part = found(robot, 0.3)
    np.testing.assert_allclose(below, [part, part], atol=1e-5)


def test_a_foot_that_still_carries_a_little_before_its_first_step_hides_nothing(robot: RobotModel) -> None:
    """A robot that walks off takes the load off its foot slowly: half a second of it passed for inertia below."""
    part = pin.Inertia(0.7, np.array([0.03, 0.01, -0.08]), np.diag([0.003, 0.004, 0.002]))
    motion, equation = moved(robot, 0.3), Equation(robot.floating_model)
    read = readings(robot, motion, part)
    shifting = (TIME > 1.8) & (TIME < 2.3)  # of the right foot's second swing
    read[shifting, 6:] += np.linspace(1.0, 0.0, shifting.sum())[:, None] * [2.0, 8.0, 20.0, 1.0, 0.5, 0.2]
    rates: Motion = pinocchio_motion(robot.floating_model, equation.tree, *motion)
    below = below_sensors(robot, equation, rates, read, PERIOD).parameters.reshape(-1, 10)
    links = [robot.frame(foot.wrench.placement)[0] for foot in robot.feet.values()]
    np.testing.assert_allclose(below[links], 2 * [part.toDynamicParameters()], atol=1e-4)


def test_what_no_swing_shows_of_a_part_is_as_of_a_plate_of_the_sole_s_size(robot: RobotModel) -> None:
    """A foot hardly turns while it swings, and strikes the floor with what turns it."""
    below, _ = found(robot, 0.05, noise=0.05)
    for own, foot in zip(below, robot.feet.values(), strict=True):
        mass, moment = own[0], own[1:4]
        along, across = np.ptp(foot.sole.polygon, axis=0)
        plate = pin.Inertia.FromBox(mass, along, across, 0.0)
        expected = pin.Inertia(mass, moment / mass, plate.inertia).toDynamicParameters()
        np.testing.assert_allclose(own[4:], expected[4:], atol=0.5 * plate.inertia[0, 0])


def test_a_part_of_next_to_no_mass_has_next_to_no_inertia(robot: RobotModel) -> None:
    """Noise of the moment over noise of the mass would be a place metres away."""
    for foot in robot.feet.values():
        assert np.abs(_as_plate(foot, 1e-6, np.array([0.006, 0.0, 0.0]))).max() < 1e-6
        assert not _as_plate(foot, -1e-3, np.array([0.006, 0.0, 0.0])).any()


@pytest.mark.parametrize("load_zero", [-80.0, 80.0])
def test_a_zero_as_large_as_what_a_foot_in_the_air_may_read_hides_no_swing(
    robot: RobotModel, load_zero: float
) -> None:
    below, part = found(robot, 0.3, load_zero=load_zero)
    np.testing.assert_allclose(below, [part, part], atol=1e-4)


def test_noise_of_the_sensors_moves_it_by_grams(robot: RobotModel) -> None:
    below, part = found(robot, 0.3, noise=1.0)
    np.testing.assert_allclose(below[:, 0], part[0], atol=0.03)
    np.testing.assert_allclose(below[:, 1:4], [part[1:4]] * 2, atol=0.01)


def test_a_foot_that_hardly_moves_shows_nothing(robot: RobotModel) -> None:
    """Gravity alone is the sensor's zero as well: no more than half of the part is believed."""
    below, part = found(robot, 1e-4, noise=1.0)
    assert (np.abs(below[:, 0]) < 0.5 * part[0]).all()


def test_a_foot_that_never_leaves_the_ground_shows_nothing(robot: RobotModel) -> None:
    equation, motion = Equation(robot.floating_model), moved(robot, 0.3)
    rates = pinocchio_motion(robot.floating_model, equation.tree, *motion)
    standing = np.zeros((COUNT, 12)) + 0.5 * robot.mass * GRAVITY
    below = below_sensors(robot, equation, rates, standing, PERIOD)
    assert not below.parameters.any()
    assert not below.zeros.any()


def test_newtons_law_closes_in_a_walk(robot: RobotModel) -> None:
    """Without it, a fifth of forward and vertical force and of the moments would be missing."""
    [residual] = newton_euler_residuals(robot, checked(robot, walked()))
    pair = residual.pair
    missing = np.std(pair.predicted - pair.measured, axis=0) / np.std(pair.measured, axis=0)
    assert missing.max() < 0.13


def test_soles_that_no_urdf_counts_are_not_taken_off_it(robot: RobotModel) -> None:
    """Of a URDF without the twin's soles Newton's law closes as well as of the one that counts them to its last links,
    and what moves above the sensors is the same."""
    description = hrp2.description()
    bodies = list(description.bodies)
    for cut in cut_feet(description, robot).values():
        bodies[cut.place] = cut.ankle
    bare = replace(robot, urdf=urdf_text(replace(description, bodies=tuple(bodies))))
    assert robot.mass - bare.mass > 1.0
    whole, without = (newton_euler_residuals(each, checked(each, walked()))[0] for each in (robot, bare))
    missing = np.std(without.pair.predicted - without.pair.measured, axis=0)
    assert (missing / np.std(without.pair.measured, axis=0)).max() < 0.13
    masses = [one.parameters[::10].sum() for one in (whole, without)]
    assert masses[1] == pytest.approx(masses[0], abs=0.1)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_what_hangs_is_counted_as_a_rule(sign: float) -> None:
    """Unless the moments are clearly worse for it: chance, and forces, tell nothing."""
    random = np.random.default_rng(0)
    hangs, chance = random.standard_normal((2, 400, 6))
    assert counts_below(hangs + chance, hangs)
    assert not counts_below(chance, hangs)
    assert counts_below(chance, sign * 0.1 * hangs)  # the squares are 1 % more
    assert not counts_below(chance, sign * 0.5 * hangs)
    loads = np.where(np.arange(6) < 3, 100.0 * hangs, 0.0)
    assert counts_below(hangs + chance - loads, hangs)
    assert not counts_below(chance + loads, hangs)
