"""MuJoCo's steps with the rubber and the slippery seconds that MuJoCo does not know."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final, Protocol

import mujoco
import numpy as np

from plantar._core import Stepping
from plantar.conventions import Array
from plantar.robot.model import RobotModel
from plantar.twin.bush import Bush
from plantar.twin.simulation.physics import Physics

LIBRARIES: Final = ("libmujoco*.so*", "libmujoco*.dylib", "mujoco*.dll")


Force = Callable[[mujoco.MjModel, mujoco.MjData], None]


class Steps(Protocol):
    """Steps a model once for each row of actuator inputs (count, nu)."""

    def run(self, rows: Array) -> None: ...


class Element:
    """One axis: a cubic spring, and an elastoplastic (Jenkins) element, a spring that slips at a fixed torque.

    The element's state is its elastic angle; it follows the deflection until `slip_angle` and then yields.
    """

    def __init__(self, slip_torque: float, slip_angle: float, hardening: float) -> None:
        self.stiffness = slip_torque / slip_angle
        self.limit = slip_angle
        self.hardening = hardening
        self.elastic = 0.0
        self.last = 0.0

    def torque(self, angle: float) -> float:
        """Torque against a deflection [N·m]; call once a step, the history counts."""
        elastic = self.elastic + angle - self.last
        limit = self.limit
        self.last = angle
        self.elastic = elastic = limit if elastic > limit else -limit if elastic < -limit else elastic
        return self.stiffness * elastic + self.hardening * angle * angle * angle


def elements(bush: Bush) -> dict[str, Element]:
    """The elements of one foot, by axis; none where the bush is a plain spring and damper."""
    if bush.is_linear:
        return {}
    return {
        "pitch": Element(bush.pitch_slip_torque, bush.pitch_slip_angle, bush.pitch_hardening),
        "roll": Element(bush.roll_slip_torque, bush.roll_slip_angle, bush.roll_hardening),
    }


class Stepper:
    """Steps one model through a motion: rubber, slippery seconds, sensors only where they are read."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        physics: Physics,
        robot: RobotModel,
        force: Force | None,
    ) -> None:
        self.model, self.data, self.physics = model, data, physics
        if force is not None:
            self.steps: Steps = InHalves(model, data, force)
            return
        rubber = _rubber(model, physics, robot)
        step = engine_step()
        self.steps = InPython(model, data, rubber) if step is None else native(model, data, rubber, step)

    def at(self, time: float) -> None:
        """Set the floor's friction for this moment."""
        friction = self.physics.friction
        for slip in self.physics.slips:
            if slip.start <= time < slip.end:
                friction = slip.friction
        self.model.geom_friction[0, 0] = friction

    def sensed(self, row: Array) -> None:
        """One step with inputs (nu,), after which the sensors hold what belongs to the positions it started from.

        Rates are those in which the step ends: the implicit damping acts on them.
        """
        model, data = self.model, self.data
        before = data.qvel.copy()
        self.blind(row[None])
        after = data.qvel.copy()
        # MuJoCo itself would read its sensors at accelerations without the implicit damping of servos and bushes, which
        # light links miss by some percent: forces would not follow from the motion, nor torques from a bush's rate.
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
        mujoco.mj_sensorPos(model, data)
        data.qvel[:], data.qacc[:] = before, (after - before) / model.opt.timestep
        mujoco.mj_rnePostConstraint(model, data)
        mujoco.mj_sensorAcc(model, data)
        data.qvel[:] = after
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mj_sensorVel(model, data)
        mujoco.mj_fwdActuation(model, data)

    def blind(self, rows: Array) -> None:
        """Steps with inputs (count, nu) whose sensors nobody reads: they are not computed."""
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
        self.steps.run(rows)


class InPython:
    """The same steps without the native core, which is tested against them; they hold the GIL half of the time."""

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, rubber: list[tuple[int, int, Element]]
    ) -> None:
        self.model, self.data, self.rubber = model, data, rubber

    def run(self, rows: Array) -> None:
        for row in rows:
            self.data.ctrl[:] = row
            for angle, torque, element in self.rubber:
                self.data.qfrc_applied[torque] = -element.torque(self.data.qpos[angle])
            mujoco.mj_step(self.model, self.data)


class InHalves:
    """Steps with a force from outside the model, which is told when positions and contacts of the step are known."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, force: Force) -> None:
        self.model, self.data, self.force = model, data, force

    def run(self, rows: Array) -> None:
        for row in rows:
            self.data.ctrl[:] = row
            mujoco.mj_step1(self.model, self.data)
            self.force(self.model, self.data)
            mujoco.mj_step2(self.model, self.data)


class _Native:
    """The native core's steps, with what their addresses point into kept alive."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, stepping: Stepping) -> None:
        self._alive = model, data
        self._stepping = stepping

    def run(self, rows: Array) -> None:
        self._stepping.run(np.ascontiguousarray(rows))


def native(
    model: mujoco.MjModel, data: mujoco.MjData, rubber: list[tuple[int, int, Element]], step: int
) -> Steps:
    """Steps of the native core, the GIL released, through MuJoCo's own step function at the address `step`."""
    places = [(angle, torque) for angle, torque, _ in rubber]
    laws = [(element.stiffness, element.limit, element.hardening) for _, _, element in rubber]
    stepping = Stepping(
        step, model._address, data._address, data.qpos, data.qfrc_applied, data.ctrl, places, laws
    )
    return _Native(model, data, stepping)


@cache
def engine_step() -> int | None:
    """Address of `mj_step` in the library that the Python package has loaded; None where it is not to be found."""
    folder = Path(mujoco.__file__).parent
    for path in (path for pattern in LIBRARIES for path in sorted(folder.glob(pattern))):
        try:
            return ctypes.cast(ctypes.CDLL(str(path)).mj_step, ctypes.c_void_p).value
        except (OSError, AttributeError):
            continue
    return None


def _rubber(model: mujoco.MjModel, physics: Physics, robot: RobotModel) -> list[tuple[int, int, Element]]:
    """Where each element finds its deflection and puts its torque, and the element."""
    found: list[tuple[int, int, Element]] = []
    if physics.bushes is None:
        return found
    for foot in robot.feet:
        for axis, element in elements(physics.bushes[foot]).items():
            joint = model.joint(f"{foot}.{axis}")
            found.append((int(joint.qposadr[0]), int(joint.dofadr[0]), element))
    return found
