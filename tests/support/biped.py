"""A biped made for tests, and exact logs of it without a physics engine.

The torso's attitude and the ankles' angles are chosen as functions of time; everything that a log holds follows from
rotation products and from high-order differences of them, never from the formulas of the package under test. Each
foot's bush obeys torque = K·deflection + C·rate + offset exactly, so what a fit should find is known. The legs' slides
hold the soles where they stand, the bushes compressed by load over vertical stiffness, and the torso above the loads.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial

import numpy as np
from scipy.spatial.transform import Rotation

from biped_robot import AS_USUAL, FEET, HIPS, SOLE_DEPTH, Mounting
from plantar.logs.motion_log import MotionLog

MASS = 60.0
WEIGHT = MASS * 9.80665
Signal = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class BushModel:
    """Stiffness [N·m/rad], damping [N·m·s/rad], offset [N·m]; hardening [N·m/rad³]."""

    stiffness: float
    damping: float
    offset: float
    hardening: float = 0.0

    def torque(self, deflection: np.ndarray, rate: np.ndarray) -> np.ndarray:
        spring = self.stiffness * deflection + self.hardening * deflection**3
        return spring + self.damping * rate + self.offset


@dataclass(frozen=True)
class Slipping(BushModel):
    """A bush with an elastoplastic element beside its spring: `slip` [N·m] from `angle` [rad] on."""

    slip: float = 4.0
    angle: float = 0.006

    def torque(self, deflection: np.ndarray, rate: np.ndarray) -> np.ndarray:
        state, states = 0.0, [0.0]
        for step in np.diff(deflection) / self.angle:
            state = min(max(state + step, -1.0), 1.0)
            states.append(state)
        return super().torque(deflection, rate) + self.slip * np.array(states)


TRUTH = {
    ("left", "pitch"): BushModel(420.0, 22.0, -1.5),
    ("left", "roll"): BushModel(350.0, 17.0, 0.6),
    ("right", "pitch"): BushModel(455.0, 26.0, 0.9),
    ("right", "roll"): BushModel(330.0, 19.0, -0.4),
}
SLIPPING = {key: Slipping(law.stiffness, law.damping, law.offset) for key, law in TRUTH.items()}
VERTICAL = 45e3  # N/m, of both bushes
HEIGHT = 0.7  # m of the torso's origin above the ground
KEPT = 24  # answers: of both feet at the times about each sample from which derivatives are taken


@dataclass(frozen=True, eq=False)  # signals are functions: a motion is the same as itself alone
class Motion:
    """A movement: torso roll, pitch, yaw [rad]; each foot's ankle pitch and roll [rad]; when a foot is in the air;
    how much of the weight goes from foot to foot."""

    name: str
    duration: float
    torso: tuple[Signal, Signal, Signal]
    ankles: Mapping[str, tuple[Signal, Signal]]
    lifts: tuple[tuple[str, float, float], ...] = ()
    shift: float = 0.06
    truth: Mapping[tuple[str, str], BushModel] = field(default_factory=lambda: dict(TRUTH))


def sines(*terms: tuple[float, float, float]) -> Signal:
    """Sum of amplitude·sin(2π·frequency·t + phase)."""
    return lambda t: np.sum([a * np.sin(2 * np.pi * f * t + p) for a, f, p in terms], axis=0) + 0.0 * t


def sway(name: str = "sway", seed: int = 0, duration: float = 20.0, **changes: object) -> Motion:
    """Both feet rock in pitch and roll, each by itself, at 0.2 to 1 Hz and by one to three degrees."""
    usual = usual_sway(name, seed, duration)
    return replace(usual, **changes) if changes else usual


@lru_cache(maxsize=KEPT)
def usual_sway(name: str, seed: int, duration: float) -> Motion:
    """`sway` without changes."""
    random = np.random.default_rng(seed)

    def wave(degrees: float) -> Signal:
        slow, fast = random.uniform(0.2, 0.4), random.uniform(0.7, 1.0)
        first, second = random.uniform(0, 2 * np.pi, 2)
        return sines((np.radians(degrees), slow, first), (0.4 * np.radians(degrees), fast, second))

    torso = (wave(0.3), wave(0.8), sines((0.0, 0.0, 0.0)))
    ankles = {foot: (wave(1.2), wave(0.9)) for foot in FEET}
    return Motion(name, duration, torso, ankles)


def times(motion: Motion, rate: float = 100.0, jitter: float = 0.0, seed: int = 0) -> np.ndarray:
    """Sampling times; `jitter` is the rms deviation of each from the even grid, in periods."""
    count = round(motion.duration * rate) + 1
    shift = np.random.default_rng(seed).normal(0, jitter, count) if jitter else np.zeros(count)
    return np.sort((np.arange(count) + shift) / rate)


def record(motion: Motion, mounting: Mounting = AS_USUAL, at: np.ndarray | None = None) -> MotionLog:
    """What the robot records of a motion, exactly."""
    if at is None and mounting is AS_USUAL:
        return usual_record(motion)  # as most logs, of which many tests ask for the same
    return recorded(motion, mounting, times(motion) if at is None else at)


@lru_cache(maxsize=KEPT)
def usual_record(motion: Motion) -> MotionLog:
    return recorded(motion, AS_USUAL, times(motion))


def recorded(motion: Motion, mounting: Mounting, t: np.ndarray) -> MotionLog:
    columns: dict[str, np.ndarray] = {}
    for foot in FEET:
        for joint, angle in zip(("pitch", "roll"), motion.ankles[foot], strict=True):
            columns[f"joint.{foot}_ankle_{joint}.position"] = angle(t)
            columns[f"joint.{foot}_ankle_{joint}.velocity"] = derivative(angle, t)
        slides = partial(leg_slides, motion, mounting, foot)
        for joint, position, velocity in zip("xyz", slides(t).T, derivative(slides, t).T, strict=True):
            columns[f"joint.{foot}_leg_{joint}.position"] = position
            columns[f"joint.{foot}_leg_{joint}.velocity"] = velocity
    columns["joint.neck.position"] = 0.1 * np.sin(t)
    columns |= _imu_columns(motion, mounting, t)
    for foot in FEET:
        wrench = sensor_wrench(motion, mounting, foot, t)
        for place, part in enumerate(f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"):
            columns[f"wrench.{foot}.{part}"] = wrench[:, place]
    return MotionLog(motion.name, t, columns)


def turned(axis: str, angle: np.ndarray) -> np.ndarray:
    """Rotations about x, y or z by angles (N,) [rad], (N, 3, 3); SciPy's general ones take 20 times as long."""
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    rotations = np.tile(np.eye(3), (len(angle), 1, 1))
    rotations[:, first, first] = rotations[:, second, second] = np.cos(angle)
    rotations[:, second, first] = np.sin(angle)
    rotations[:, first, second] = -rotations[:, second, first]
    return rotations


def kept(rotation: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
    """`rotation` of (motion, ..., times) with its latest answers kept: a log asks for each many times."""
    answers: dict[tuple[object, ...], tuple[Motion, np.ndarray]] = {}

    def look_up(motion: Motion, *foot_and_times: object) -> np.ndarray:
        *foot, t = foot_and_times
        key = (id(motion), *foot, t.tobytes())
        if key not in answers:
            found = rotation(motion, *foot_and_times)
            found.flags.writeable = False
            answers[key] = (
                motion,
                found,
            )  # the motion, too: its id is not given to another as long as it is here
            if len(answers) > KEPT:
                del answers[next(iter(answers))]
        return answers[key][1]

    return look_up


@kept
def torso_rotation(motion: Motion, t: np.ndarray) -> np.ndarray:
    """Torso to world, (N, 3, 3)."""
    roll, pitch, yaw = (angle(t) for angle in motion.torso)
    return turned("z", yaw) @ turned("y", pitch) @ turned("x", roll)


@kept
def foot_rotation(motion: Motion, foot: str, t: np.ndarray) -> np.ndarray:
    """Foot link to world, (N, 3, 3)."""
    pitch, roll = motion.ankles[foot]
    return torso_rotation(motion, t) @ turned("y", pitch(t)) @ turned("x", roll(t))


def torso_position(motion: Motion, t: np.ndarray) -> np.ndarray:
    """The torso's origin in the world, (N, 3): sideways above the loads."""
    sideways = 2 * HIPS["left"][1] * motion.shift * np.sin(0.7 * t)
    return np.column_stack([np.zeros_like(t), sideways, np.full_like(t, HEIGHT)])


def leg_slides(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """How far the leg's three slides are out [m], (N, 3), for a sole that stands still on the ground."""
    torso, ankle = torso_rotation(motion, t), foot_rotation(motion, foot, t)
    pitch, roll = deflection(motion, mounting, foot, t).T
    bent = turned("y", pitch) @ turned("x", roll)
    sole_from_centre = mounting.bush.rotation.T @ (
        np.array([0.0, 0.0, -SOLE_DEPTH]) - np.array(mounting.bush.xyz)
    )
    stands_at = np.array([0.0, HIPS[foot][1], 0.0])
    centre = stands_at - ankle @ mounting.bush.rotation @ bent @ sole_from_centre
    origin = centre - np.einsum("nij,nj->ni", ankle, bush_centre(motion, mounting, foot, t))
    return np.einsum("nji,nj->ni", torso, origin - torso_position(motion, t)) - HIPS[foot]


def bush_centre(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """Where both hinges sit in the foot link, (N, 3): above the resting centre by the compression."""
    compression = bush_force(motion, mounting, foot, t)[:, 2:] / VERTICAL
    return np.array(mounting.bush.xyz) + compression * mounting.bush.rotation[:, 2]


def bush_force(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """Force of the ground in the bush frame, (N, 3): the load, and some newtons along the ground."""
    level = np.column_stack([4 * np.sin(1.3 * t), 3 * np.cos(0.9 * t), np.zeros_like(t)])
    sideways = np.einsum("nji,nj->ni", foot_rotation(motion, foot, t), level) @ mounting.bush.rotation
    upward = vertical_load(motion, foot, t)[:, None] * up_in_bush(motion, mounting, foot, t)
    return upward + contact_share(motion, foot, t)[:, None] * sideways


def up_in_bush(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """The world's up seen from the bush frame, (N, 3)."""
    return foot_rotation(motion, foot, t)[:, 2, :] @ mounting.bush.rotation


def deflection(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """Pitch and roll of the sole relative to the ankle [rad], (N, 2): the sole stays level."""
    n = up_in_bush(motion, mounting, foot, t)
    return np.column_stack([np.arctan2(n[:, 0], n[:, 2]), -np.arcsin(n[:, 1])])


def deflection_rate(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    return derivative(lambda s: deflection(motion, mounting, foot, s), t)


def bush_torque(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """The law's generalised torques in pitch and roll, (N, 2)."""
    q, v = deflection(motion, mounting, foot, t), deflection_rate(motion, mounting, foot, t)
    laws = [motion.truth[foot, axis] for axis in ("pitch", "roll")]
    return np.column_stack([law.torque(q[:, i], v[:, i]) for i, law in enumerate(laws)])


def sensor_wrench(motion: Motion, mounting: Mounting, foot: str, t: np.ndarray) -> np.ndarray:
    """What the force sensor reads, (N, 6): the law's torque at the bush, moved to the sensor and into its axes."""
    pitch = deflection(motion, mounting, foot, t)[:, 0]
    pitch_torque, roll_torque = bush_torque(motion, mounting, foot, t).T
    roll_axis = turned("y", pitch)[:, :, 0]
    torque = pitch_torque[:, None] * [0.0, 1.0, 0.0] + roll_torque[:, None] * roll_axis
    torque = contact_share(motion, foot, t)[:, None] * torque
    # Into the foot link's axes, then to the sensor.
    force, torque = (
        bush_force(motion, mounting, foot, t) @ mounting.bush.rotation.T,
        torque @ mounting.bush.rotation.T,
    )
    torque = torque + np.cross(bush_centre(motion, mounting, foot, t) - mounting.wrench.xyz, force)
    return np.hstack([force @ mounting.wrench.rotation, torque @ mounting.wrench.rotation]) / mounting.sign


def contact_share(motion: Motion, foot: str, t: np.ndarray) -> np.ndarray:
    """1 where the foot stands, 0 in the air, (N,), smooth over 0.2 s."""
    share = np.ones_like(t)
    for name, start, end in motion.lifts:
        if name == foot:
            down = np.clip((t - start + 0.1) / 0.2, 0, 1), np.clip((end + 0.1 - t) / 0.2, 0, 1)
            share = share * (1 - np.minimum(*(x * x * (3 - 2 * x) for x in down)))
    return share


def vertical_load(motion: Motion, foot: str, t: np.ndarray) -> np.ndarray:
    """The foot's share of the weight [N], (N,): a foot in the air gives its share to the other."""
    left = 0.5 + motion.shift * np.sin(0.7 * t)
    wished = {
        "left": left * contact_share(motion, "left", t),
        "right": (1 - left) * contact_share(motion, "right", t),
    }
    total = wished["left"] + wished["right"]
    return np.where(total > 0, WEIGHT * wished[foot] / np.where(total > 0, total, 1.0), 0.0)


def derivative(function: Signal, t: np.ndarray, step: float = 2e-3) -> np.ndarray:
    """First derivative by sixth-order central differences."""
    weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    return sum(w * (function(t + k * step) - function(t - k * step)) for k, w in weights.items()) / step


def second_derivative(function: Signal, t: np.ndarray, step: float = 2e-3) -> np.ndarray:
    """Second derivative by sixth-order central differences."""
    weights = {1: 3 / 2, 2: -3 / 20, 3: 1 / 90}
    around = sum(w * (function(t + k * step) + function(t - k * step)) for k, w in weights.items())
    return (around - 49 / 18 * function(t)) / step**2


def _imu_columns(motion: Motion, mounting: Mounting, t: np.ndarray) -> dict[str, np.ndarray]:
    torso = torso_rotation(motion, t)
    spin = np.swapaxes(torso, 1, 2) @ derivative(lambda s: torso_rotation(motion, s), t)
    rate = np.column_stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]]) @ mounting.imu.rotation
    at = np.array(mounting.imu.xyz)
    moved = second_derivative(lambda s: torso_position(motion, s) + torso_rotation(motion, s) @ at, t)
    world = torso @ mounting.imu.rotation
    proper = np.einsum("nji,nj->ni", world, moved + [0.0, 0.0, 9.80665])
    quaternion = Rotation.from_matrix(world).as_quat(scalar_first=True)
    kinds = {
        "orientation": ("wxyz", quaternion),
        "angular_velocity": ("xyz", rate),
        "linear_acceleration": ("xyz", proper),
    }
    return {
        f"imu.chest.{kind}.{axis}": values[:, i]
        for kind, (axes, values) in kinds.items()
        for i, axis in enumerate(axes)
    }


def drawn_up(log: MotionLog, foot: str, swings: np.ndarray, height: float = 0.03) -> MotionLog:
    """The log with one leg drawn up by `height` [m] in the middle of `swings` (N,), as its encoders read it."""
    name, step = f"joint.{foot}_leg_z", float(np.median(np.diff(log.time)))
    window = np.hanning(round(0.1 / step) + 2)
    up = height * np.convolve(swings.astype(float), window / window.sum(), mode="same")
    changed = {
        f"{name}.position": log.column(f"{name}.position") + up,
        f"{name}.velocity": log.column(f"{name}.velocity") + np.gradient(up, log.time),
    }
    return log.with_columns(changed)
