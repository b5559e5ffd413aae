"""A foot on points alone in MuJoCo, pressed on the floor and turned: what it really holds with, at which step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np

from plantar.conventions import Array, Axis
from plantar.exporters.contact.points import Point, PointFoot

# The contact's own inertia, as a time: an inertia of C times this stands beside the damper. It is what lets a light
# foot stand at steps of up to this length; the bush's C/K is ten times longer.
INERTIA_TIME: Final = 0.004  # s
# s: MuJoCo raises time constants to two steps, and the longest step of the fit is 4 ms
SHORTEST: Final = 0.008
RADIUS: Final = 0.002  # m, of the sphere that is a point
# Friction as much harder than the normal: else a soft sole creeps under a sideways force, and a foot seems softer.
IMPRATIO: Final = 100.0
MARKED: Final = 0.25  # of the angle at which a point leaves the ground: where K and C are measured
SETTLE: Final = 12.0  # times C/K until a foot stands still
HINGE: Final[Mapping[Axis, int]] = {"roll": 0, "pitch": 1}
LIGHT: Final = (1.0, 5e-3)  # kg and kg·m² of the foot itself: light, the hardest case for a long step


@dataclass(frozen=True)
class Measured:
    """Stiffness [N·m/rad] and damping [N·m·s/rad] about the bush centre; NaN where the foot did not stand still."""

    stiffness: float
    damping: float


def contact_attributes(point: Point, inverse_mass: float) -> dict[str, str]:
    """MJCF attributes of the geom that is a point: `solref`, `solimp`, `margin`, `gap`.

    A contact of constant impedance d pushes with (stiffness·r - damping·v) / ((1 - d) Â) and adds an inertia
    m = d / ((1 - d) Â), where Â is MuJoCo's inverse mass of the two bodies at the model's reference pose: so
    (stiffness, damping) = (k, c)(1 - d)Â with d = mÂ / (1 + mÂ) is a spring k and a damper c (MuJoCo, Computation,
    solver parameters). Holds for elliptic cones. Written are the time constant 2 / damping and the damping ratio
    damping / (2 √stiffness), which other engines read too; the inertia keeps the time constant above the two steps
    that MuJoCo asks for. A point without damper has -stiffness and -damping, which only MuJoCo reads.

    Args:
        point: of the foot. inverse_mass: `body_invweight0` of the foot's body, translational [1/kg].
    """
    inertia = max(INERTIA_TIME * point.damping, 0.5 * INERTIA_TIME**2 * point.stiffness)
    impedance = inertia * inverse_mass / (1 + inertia * inverse_mass)
    scale = (1 - impedance) * inverse_mass
    stiffness, damping = point.stiffness * scale, point.damping * scale
    if damping > 0:
        solref = f"{2 / damping:.9g} {0.5 * damping / np.sqrt(stiffness):.9g}"
    else:
        solref = f"{-stiffness:.9g} -1e-9"
    return {
        "solref": solref,
        "solimp": f"{impedance:.9g} {impedance:.9g} 0.001 0.5 2",
        "margin": "0",
        "gap": "0",
    }


# One export's feet are mostly the next one's, and each takes tenths of a second.
@lru_cache(maxsize=4096)
def standing_stiffness(foot: PointFoot, axis: Axis, load: float, step: float, share: float) -> float:
    """K [N·m/rad] of where a foot stands under a load and a torque about one axis, either way; NaN where it falls.

    Args:
        foot: on points. axis: pitch or roll. load: at the bush centre [N]. step: of the simulation [s].
        share: how far it is turned, of the angle at which a point leaves the ground.
    """
    alone = _Alone(foot, step)
    torque, settle = _push(foot, axis, load, share)
    ends = [alone.turned(axis, load, sign * torque, settle) for sign in (1.0, -1.0)]
    return 2 * torque / (ends[0] - ends[1])


@lru_cache(maxsize=4096)
def measured(foot: PointFoot, axis: Axis, load: float, step: float) -> Measured:
    """K as `standing_stiffness` says and C of how the foot follows a swing, at the share `MARKED`."""
    held = standing_stiffness(foot, axis, load, step, MARKED)
    if not np.isfinite(held):
        return Measured(np.nan, np.nan)
    k, c = foot.turning(axis)
    rate = k / c if c > 0 else 10.0
    torque, settle = _push(foot, axis, load, MARKED)
    response = _Alone(foot, step).swung(axis, load, torque, rate, settle)
    return Measured(held, float((torque / response).imag / rate) if response else np.nan)


def _push(foot: PointFoot, axis: Axis, load: float, share: float) -> tuple[float, float]:
    """Torque [N·m] that turns a foot by a share of the angle at which a point leaves the ground; s until it stands."""
    k, c = foot.turning(axis)
    return share * foot.touching_angle(axis, load) * k, max(SETTLE * c / k, 0.5)


class _Alone:
    """One foot in MuJoCo, its frame in the bush centre, on a plane."""

    def __init__(self, foot: PointFoot, step: float) -> None:
        import mujoco

        mass, inertia = LIGHT
        points = "".join(
            f'<geom type="sphere" size="{RADIUS}" mass="0" priority="1" condim="3" '
            f'pos="{p.x} {p.y} {RADIUS - foot.depth - p.lower}" '
            + " ".join(f'{key}="{value}"' for key, value in contact_attributes(p, 1 / mass).items())
            + "/>"
            for p in foot.points
        )
        self.model: Any = mujoco.MjModel.from_xml_string(
            f'<mujoco><option timestep="{step}" cone="elliptic" impratio="{IMPRATIO}" gravity="0 0 0">'
            # Spheres on one plane all touch, and are one body's: sorting out which takes a tenth of each step.
            '<flag midphase="disable" island="disable"/></option>'
            f'<worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 {foot.depth}"><freejoint/>'
            f'<inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>'
            f"{points}</body></worldbody></mujoco>"
        )
        self.model.body_invweight0[1, 0] = 1 / mass
        self.foot, self.step = foot, step

    def turned(self, axis: Axis, load: float, torque: float, settle: float) -> float:
        """Angle [rad] after standing under a constant torque [N·m]; NaN where it falls or does not stand still."""
        track = self._track(axis, load, np.full(round(settle / self.step), torque))
        tail = track[-max(10, len(track) // 10) :]
        still = bool(np.ptp(tail) <= 0.01 * abs(tail[-1])) and abs(float(tail[-1])) < 0.5
        return float(tail.mean()) if still else float("nan")

    def swung(self, axis: Axis, load: float, torque: float, rate: float, settle: float) -> complex:
        """Complex amplitude of the angle [rad] under torque·cos(rate·t), from the period after it has settled."""
        period = 2 * np.pi / rate
        times = np.arange(round((settle + period) / self.step)) * self.step
        track = self._track(axis, load, torque * np.cos(rate * times))
        last = times >= times[-1] - period
        # The angle that a row of `_track` ends in belongs to the time after its step.
        late = times[last] + self.step
        basis = np.column_stack([np.cos(rate * late), -np.sin(rate * late), np.ones(late.size)])
        real, imaginary, _ = np.linalg.lstsq(basis, track[last], rcond=None)[0]
        return complex(real, imaginary)

    def _track(self, axis: Axis, load: float, torques: Array) -> Array:
        """Angle after each step [rad], one torque a step, from where the load alone has been put down."""
        import mujoco
        from mujoco.rollout import rollout

        data, whole = mujoco.MjData(self.model), int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
        data.qpos[2] -= self.foot.sink(load)
        start = np.empty(mujoco.mj_stateSize(self.model, whole))
        mujoco.mj_getState(self.model, data, start, whole)
        pushes = np.zeros((1, len(torques), *data.xfrc_applied.shape))
        pushes[0, :, 1, 2], pushes[0, :, 1, 3 + HINGE[axis]] = -load, torques
        applied = int(mujoco.mjtState.mjSTATE_XFRC_APPLIED)
        states, _ = rollout(
            self.model, data, start[None], pushes.reshape(1, len(torques), -1), control_spec=applied
        )
        return np.asarray(2 * states[0, :, 5 + HINGE[axis]])  # behind the time: position, quaternion
