"""Equations 1 to 3: regressors, contact transfer and base parameters over the native core."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics.base_parameters import BaseParameters, base_parameters
from plantar.dynamics.equation import Contact, Equation, model_parameters
from plantar.dynamics.fit import BaseParameterFit, fit_base_parameters, fit_base_parameters_chunked
from plantar.dynamics.motion import Motion, pinocchio_motion
from plantar.dynamics.stream import EquationStream, RowFactor

__all__ = [
    "BaseParameterFit",
    "BaseParameters",
    "Contact",
    "Equation",
    "EquationStream",
    "Motion",
    "RowFactor",
    "base_parameters",
    "fit_base_parameters",
    "fit_base_parameters_chunked",
    "model_parameters",
    "pinocchio_motion",
    "regressor",
]


def regressor(model: pin.Model, q: Array, v: Array, a: Array, threads: int = 0) -> Array:
    """Y_BI and Y_JI of eq. 1, dense, for small N; equal to Pinocchio's `computeJointTorqueRegressor`.

    Args:
        model: the robot.
        q: (N, nq) positions in Pinocchio's conventions [m, rad].
        v: (N, nv) velocities.
        a: (N, nv) accelerations.
        threads: 0 for as many as are worth starting.

    Returns:
        (N, nv, 10 n_links): inertial parameters to generalised forces.

    Raises:
        RobotError: a joint type that is not supported. DataError: wrong shapes or values that are not finite.

    Example:
        >>> import numpy as np, pinocchio as pin
        >>> from plantar import dynamics
        >>> model = pin.buildSampleModelManipulator()
        >>> q, v, a = np.random.default_rng(0).normal(size=(3, 5, model.nv))
        >>> dynamics.regressor(model, q, v, a).shape == (5, model.nv, 10 * (model.njoints - 1))
        True
    """
    equation = Equation(model)
    return np.moveaxis(
        equation.regressor(pinocchio_motion(model, equation.tree, q, v, a), threads=threads), -1, 0
    )
