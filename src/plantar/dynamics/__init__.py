"""Equations 1 to 3: regressors, contact transfer and base parameters over the native core."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics.base_parameters import BaseParameters, base_parameters, parameter_name
from plantar.dynamics.equation import Contact, Equation, model_parameters
from plantar.dynamics.fit import (
    BaseParameterFit,
    fit_base_parameters,
    fit_base_parameters_chunked,
    solve_triangle,
)
from plantar.dynamics.motion import Motion, pinocchio_motion
from plantar.dynamics.stream import EquationStream, RowFactor, stacked

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
    "parameter_name",
    "pinocchio_motion",
    "regressor",
    "solve_triangle",
    "stacked",
]


def regressor(model: pin.Model, q: Array, v: Array, a: Array, threads: int = 0) -> Array:
    """Y_BI and Y_JI of eq. 1, dense: (N, nv, 10 n_links), for small N.

    q: (N, nq); v, a: (N, nv) in Pinocchio's conventions; equal to its `computeJointTorqueRegressor`. Raises RobotError
    for a joint type that is not supported, DataError for wrong shapes or values that are not finite.
    """
    equation = Equation(model)
    return np.moveaxis(
        equation.regressor(pinocchio_motion(model, equation.tree, q, v, a), threads=threads), -1, 0
    )
