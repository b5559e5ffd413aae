"""Where the feet of a walk stand and swing, and the zero-moment point that leads from one to the next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from scipy.interpolate import PchipInterpolator

from plantar.conventions import Array
from plantar.motions.gait import Gait
from plantar.motions.profile import smooth_step

REST = 2.0  # s of standing still before and after a motion
SHIFT = 1.5  # s at least, to bring the weight over the first foot and back between the feet
DOUBLE = 0.25  # of a step's period on both feet
SHORTEST_DOUBLE = 0.2  # s: the weight cannot change feet more quickly
CLEARANCE = 0.05  # m: height of the swing
CARRIED = 0.15  # of the swing: lifts before it goes forward, and is in place before it lands
# The ZMP passes from the heel's side to the toes' while one foot stands: by so much of a step on either side of the
# sole's middle, and by no more than so much of the half length.
TRAVEL, MOST_TRAVEL = 0.2, 0.4
# Usual and largest error of a robot's belief how high the floor is where a foot lands: a few millimetres, from servos,
# links and floors. Without it every landing would be as soft as no robot's is; on narrow soles robots are more exact
# or fall, so that these are shares of the sole's half width.
MISJUDGED, MOST_MISJUDGED = 0.03, 0.06


@dataclass(frozen=True)
class Swing:
    """One foot in the air from `start` to `end` [s], from one place (x, y, yaw) [m, rad] to another.

    The robot believes the floor `floor` [m] too high where the foot lands, and has unlearnt it `settled` [s] later.
    """

    foot: str
    start: float
    end: float
    origin: Array
    goal: Array
    floor: float
    settled: float

    def poses(self, time: Array) -> Array:
        """Poses of the sole, (N, 4, 4); it lifts and lands level, at rest and without acceleration as planned."""
        phase = np.clip((time - self.start) / (self.end - self.start), 0.0, 1.0)
        carried = smooth_step((phase - CARRIED) / (1 - 2 * CARRIED))
        x, y, yaw = (self.origin + carried[:, None] * (self.goal - self.origin)).T
        believed = self.floor * carried * (1 - smooth_step((time - self.end) / self.settled))
        return flat_poses(x, y, CLEARANCE * (4 * phase * (1 - phase)) ** 3 + believed, yaw)


@dataclass(frozen=True)
class Footsteps:
    """Both feet's places (x, y, yaw) at the start, the swings in their order, and the ZMP's way points.

    `waypoints` (k, 3): time [s], x and y [m]; the ZMP passes through them without overshoot.
    """

    start: Mapping[str, Array]
    swings: tuple[Swing, ...]
    waypoints: Array

    @property
    def duration(self) -> float:
        return float(self.waypoints[-1, 0])

    def zmp(self, time: Array) -> Array:
        """The planned zero-moment point, (N, 2) [m]."""
        return np.asarray(PchipInterpolator(self.waypoints[:, 0], self.waypoints[:, 1:])(time))

    def soles(self, time: Array) -> dict[str, Array]:
        """Poses of each sole, (N, 4, 4)."""
        found = {}
        for foot, (x, y, yaw) in self.start.items():
            poses = np.tile(flat_poses(*np.array([[x], [y], [0.0], [yaw]])), (time.size, 1, 1))
            for swing in self.swings:
                if swing.foot == foot:
                    after = time >= swing.start
                    poses[after] = swing.poses(time[after])
            found[foot] = poses
        return found

    def stands(self, time: Array) -> dict[str, Array]:
        """Whether each foot is on the floor, (N,)."""
        found = {foot: np.ones(time.size, dtype=bool) for foot in self.start}
        for swing in self.swings:
            found[swing.foot] &= (time <= swing.start) | (time >= swing.end)
        return found

    def heading(self, time: Array) -> Array:
        """Yaw of the body, (N,) [rad]: the mean of the feet's."""
        yaws = [np.unwrap(np.arctan2(poses[:, 1, 0], poses[:, 0, 0])) for poses in self.soles(time).values()]
        return np.asarray(np.mean(yaws, axis=0))


def footsteps(gait: Gait, soles: Mapping[str, pin.SE3], middles: Mapping[str, Array]) -> Footsteps:
    """Steps of `gait` from soles that stand level, left foot first.

    `middles`: of each sole's outline in the sole's frame, x and y, and half its length and width, (4,)
    [m].
    """
    places = {foot: np.array([*sole.translation[:2], _yaw(sole)]) for foot, sole in soles.items()}
    path = np.mean(list(places.values()), axis=0)
    aside = {foot: place - path for foot, place in places.items()}
    start, double = dict(places), max(gait.period * DOUBLE, SHORTEST_DOUBLE)
    random = np.random.default_rng(gait.trial)
    half_length, half_width = np.min([middle[2:] for middle in middles.values()], axis=0)
    floors = half_width * np.clip(random.normal(0, MISJUDGED, gait.steps), -MOST_MISJUDGED, MOST_MISJUDGED)
    travel = min(TRAVEL * gait.step, MOST_TRAVEL * half_length)
    shift = max(SHIFT, gait.period)
    begin = REST + shift
    between = _between(places, middles)
    waypoints = [(0.0, *between), (REST, *between)]
    order = sorted(places)  # left before right
    swings = []
    for number in range(gait.steps):
        foot, other = order[number % 2], order[(number + 1) % 2]
        last = number == gait.steps - 1
        if not last:
            path = _advanced(path, gait)
        goal = path + _turned(aside[foot], path[2])
        swing = Swing(
            foot, begin, begin + gait.period - double, places[foot], goal, float(floors[number]), double
        )
        first = 0.0 if number == 0 else -travel
        waypoints.append((swing.start, *_on_sole(places[other], middles[other], first)))
        waypoints.append((swing.end, *_on_sole(places[other], middles[other], 0.0 if last else travel)))
        places[foot] = goal
        swings.append(swing)
        begin += gait.period
    between = _between(places, middles)
    end = swings[-1].end + shift
    waypoints += [(end, *between), (end + REST, *between)]
    return Footsteps(start, tuple(swings), np.array(waypoints))


def flat_poses(x: Array, y: Array, z: Array, yaw: Array) -> Array:
    """Poses (N, 4, 4) of soles that are level."""
    poses = np.tile(np.eye(4), (x.size, 1, 1))
    cosine, sine = np.cos(yaw), np.sin(yaw)
    poses[:, 0, 0], poses[:, 0, 1], poses[:, 1, 0], poses[:, 1, 1] = cosine, -sine, sine, cosine
    poses[:, 0, 3], poses[:, 1, 3], poses[:, 2, 3] = x, y, z
    return poses


def _advanced(path: Array, gait: Gait) -> Array:
    """The middle between the feet (x, y, yaw) one step later, on an arc."""
    along = path[2] + gait.turn / 2
    return np.asarray(path + [gait.step * np.cos(along), gait.step * np.sin(along), gait.turn])


def _turned(offset: Array, yaw: float) -> Array:
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.array([cosine * offset[0] - sine * offset[1], sine * offset[0] + cosine * offset[1], offset[2]])


def _on_sole(place: Array, middle: Array, forward: float) -> Array:
    """A point on the floor, `forward` of the middle of a sole's outline, (2,)."""
    return np.asarray(place[:2] + _turned(np.array([middle[0] + forward, middle[1], 0.0]), place[2])[:2])


def _between(places: Mapping[str, Array], middles: Mapping[str, Array]) -> Array:
    return np.asarray(np.mean([_on_sole(places[foot], middles[foot], 0.0) for foot in places], axis=0))


def _yaw(pose: pin.SE3) -> float:
    return float(np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0]))
