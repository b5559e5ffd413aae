"""What a regularised fit found, as a result: parameters, what the motions excite, the regularisation."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from plantar.conventions import INERTIAL_NAMES, INERTIAL_UNITS
from plantar.dynamics.base_parameters import parameter_name
from plantar.dynamics.consistency import is_consistent
from plantar.dynamics.equation import PER_LINK
from plantar.dynamics.fit import solve_triangle
from plantar.estimation.residual_covariance import interval95, relative_std_percent
from plantar.notes import Note, listing, unique
from plantar.results.dynamics import BaseParameter, DynamicsResult, InertialParameter, JointParameter
from plantar.robot.identified_urdf import write_inertias
from plantar.robot.model import RobotModel
from plantar.whole_body.covariance import Uncertainty
from plantar.whole_body.folds import Samples
from plantar.whole_body.regularised_fit import RegularisedFit
from plantar.whole_body.scores import Place, scored, worse_notes
from plantar.whole_body.whole_logs import WholeLogs


def result_of(
    schema: str,
    logs: WholeLogs,
    fit: RegularisedFit,
    trust: Uncertainty,
    fitted: Sequence[Samples],
    unseen: Sequence[Samples],
    places: Sequence[Place],
    settings: Mapping[str, Any],
    *,
    parameters: tuple[JointParameter, ...] = (),
    notes: Sequence[Note] = (),
) -> DynamicsResult:
    """The result of eq. 2 or eq. 3, scored in `places`; notes on excitation and regularisation follow those given."""
    robot = logs.body.robot
    rank, condition, excitation = excitation_of(fit)
    validation, residuals = scored(fit, fitted, unseen, places)
    urdf, moved = identified_urdf(robot, fit)
    return DynamicsResult(
        schema=schema,
        robot=robot.name,
        inputs=logs.inputs,
        settings={**settings, "strength": fit.regularisation},
        rank=rank,
        condition_number=condition,
        base_parameters=base_rows(robot, fit, trust),
        inertial_parameters=inertial_rows(fit),
        parameters=parameters,
        validation=validation,
        notes=unique([*logs.notes, *notes, *worse_notes(validation), *excitation, *fit_notes(fit), *moved]),
        urdf=urdf,
        residuals=residuals,
    )


def identified_urdf(robot: RobotModel, fit: RegularisedFit) -> tuple[str, tuple[Note, ...]]:
    """The URDF's text with the inertias found, and notes on the links that carry them."""
    root = ET.fromstring(robot.urdf)
    model = robot.floating_model if fit.equation.floating else robot.model
    bodies = dict(zip(fit.equation.links, fit.inertial.reshape(-1, PER_LINK), strict=True))
    notes = write_inertias(root, model, bodies)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n", notes


def excitation_of(fit: RegularisedFit) -> tuple[int, float, list[Note]]:
    """Rank and condition number of the weighted regressor, and what the motions do not excite."""
    triangle = np.ascontiguousarray(fit.triangle)
    solution = solve_triangle(triangle)
    singular = np.linalg.svd(triangle[:-1, :-1], compute_uv=False)
    condition = float(singular[0] / singular[solution.rank - 1]) if solution.rank else float("inf")
    if solution.full:
        return solution.rank, condition, []
    n_base, said = len(fit.base), []
    names = [fit.base.names[k] for k in np.flatnonzero(~solution.excited[:n_base])]
    if names:
        said.append(f"from the URDF, not from the data: {listing(names)}")
    if terms := int(np.sum(~solution.excited[n_base:])):
        said.append(f"{terms} of the joints' terms cannot be told apart")
    text = f"the motions excite {solution.rank} of {len(solution.values)} directions; {'; '.join(said)}"
    return solution.rank, condition, [Note("unexcited", "warning", text)]


def fit_notes(fit: RegularisedFit) -> list[Note]:
    """Which regularisation weight was chosen, and its held-out error beside that of the smallest and largest."""
    if np.isinf(fit.regularisation):
        return []
    if not fit.held_out:
        text = "too few samples for cross-validation: a weak regularisation towards the URDF was assumed"
        return [Note("regularisation", "warning", text)]
    held_out = {tried.regularisation: float(np.sqrt(tried.errors.mean())) for tried in fit.held_out}
    text = (
        f"regularised towards the URDF with weight {fit.regularisation:g}: "
        f"held-out error {held_out[fit.regularisation]:.4g} of the fit's, "
        f"{held_out[min(held_out)]:.4g} at the smallest weight, {held_out[max(held_out)]:.4g} at the largest"
    )
    notes = [Note("regularisation", "info", text)]
    links = zip(fit.equation.links, fit.prior.cad.reshape(-1, len(INERTIAL_NAMES)), strict=True)
    impossible = [link for link, cad in links if not is_consistent(cad)]
    if impossible:
        text = f"inertias in the URDF that no body can have: {', '.join(impossible)}"
        notes.append(Note("cad_inconsistent", "warning", text))
    return notes


def base_rows(robot: RobotModel, fit: RegularisedFit, trust: Uncertainty) -> tuple[BaseParameter, ...]:
    """Base parameters; those of a floating robot follow its force sensors' gain, as unsure as that is."""
    values = fit.base.grouping @ fit.inertial
    deviations = np.hypot(trust.base, robot.uncertainty.wrench_gain * values * fit.equation.floating)
    return tuple(
        BaseParameter(
            expression,
            float(value),
            float(std),
            interval95(float(value), float(std), trust.freedom),
            relative_std_percent(float(value), float(std)),
        )
        for expression, value, std in zip(fit.base.expressions, values, deviations, strict=True)
    )


def inertial_rows(fit: RegularisedFit) -> tuple[InertialParameter, ...]:
    rows = []
    for index, (value, cad) in enumerate(zip(fit.inertial, fit.prior.cad, strict=True)):
        link, name = parameter_name(fit.equation.links, index).rsplit(".", 1)
        unit = INERTIAL_UNITS[index % len(INERTIAL_NAMES)]
        rows.append(InertialParameter(link, name, unit, float(value), float(cad)))
    return tuple(rows)
