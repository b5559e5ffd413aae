"""Friction, springs, offsets and actuator inertia of the joints, with the inertias known or found together (eq. 3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, get_args

import numpy as np

from plantar.choices import one_of, settings_of
from plantar.conventions import Array
from plantar.errors import DataError, RobotError
from plantar.estimation.residual_covariance import interval95
from plantar.logs.inputs import LogInputs, RobotInput, robot_of
from plantar.notes import Note
from plantar.results.dynamics import JOINTS_SCHEMA, DynamicsResult, JointParameter
from plantar.results.feet import Verdict
from plantar.robot.model import RobotModel
from plantar.whole_body.covariance import Uncertainty, uncertainty
from plantar.whole_body.equations import TERM_UNITS, inertial_samples, joint_samples
from plantar.whole_body.folds import Samples
from plantar.whole_body.regularised_fit import RegularisedFit, RegularisedProblem, as_good
from plantar.whole_body.regularised_result import fit_notes, result_of
from plantar.whole_body.scores import Place
from plantar.whole_body.settings import DynamicsSettings
from plantar.whole_body.whole_logs import Progress, WholeLogs, prepare_logs

FRICTION = ("viscous", "coulomb", "offset")  # of a joint that the robot file does not describe
# Cables and rotors, where held-out data speak for them. A rotor left out passes for a spring that pushes.
FURTHER = ((), ("stiffness",), ("inertia",), ("stiffness", "inertia"))
POSITIVE = ("viscous", "coulomb", "stiffness", "inertia")
USABLE_SHARE = 0.2  # half width of the interval over the value
# Of the joint's rms torque: an offset known to within it is usable even where it is near zero.
OFFSET_SHARE = 0.05
SENSORS_ZERO = "zeros of the force sensor below the joint count as its offset"
SENSORS_ERRORS = (
    "held-out data chose this term, and its interval leaves out what gains and delays of sensors do to it "
    "(name the joint's terms in the robot file where they are known)"
)
# Those of given inertias.
UNCOUNTED = "the standard deviations of the joints' terms do not include their errors"

Inertia = Literal["together", "first", "known"]


def identify_joints(
    robot: RobotInput,
    logs: LogInputs,
    validate: LogInputs = (),
    settings: DynamicsSettings | None = None,
    progress: Progress = lambda _: None,
    *,
    inertia: Inertia = "together",
) -> DynamicsResult:
    """Friction, springs, offsets and actuator inertia of the joints from their torques (eq. 3).

    Terms are those of the robot file; a joint that it does not describe has viscous and Coulomb friction and an offset,
    a spring and a rotor's inertia where held-out parts of `logs` ask for them. Passive joints need no effort.

    Args:
        robot: a robot, or the path of its robot file.
        logs: logs to fit, or their paths; one or several.
        validate: logs to score only.
        settings: what to choose by hand.
        progress: called with a line for each step.
        inertia: "together" fits the inertial parameters with the joints', "first" takes those of eq. 2 (floating
            bases), "known" the URDF's.

    Returns:
        Each joint's terms [N·m, N·m/rad, N·m·s/rad, kg·m²; of one that slides N, N/m, N·s/m, kg] with 95 % intervals
        and verdicts, and scores [N·m or N].

    Raises:
        SettingsError: an unknown `inertia`. RobotError, LogError, DataError: the input cannot be used, in one line.
        MissingExtra: clarabel is not installed.

    Example:
        >>> import plantar
        >>> result = plantar.identify_joints("arm.yaml", "arm.csv", inertia="known")
        >>> row = result.parameter("elbow_joint", "viscous")
        >>> round(row.value), row.unit, row.verdict
        (3, 'N.m.s/rad', 'usable')
    """
    one_of("inertia", inertia, get_args(Inertia))
    robot = robot_of(robot)
    settings = settings_of(settings, DynamicsSettings)
    if inertia == "first" and robot.base == "fixed":
        message = "a fixed base has no base rows to identify inertias from first"
        raise RobotError(message, path=robot.path, valid="inertia: together, known")
    made = prepare_logs(robot, logs, validate, settings, progress)
    body = made.body
    given, said = _given(made, inertia, progress)
    terms, fit, choice = _chosen(made, given, progress)
    progress("deviations")
    fitted, unseen = (
        [joint_samples(body, whole, made.calibration, terms) for whole in wholes]
        for wholes in (made.fitted, made.unseen)
    )
    trust = uncertainty(fit, fitted)
    chosen = {
        **settings.to_dict(),
        "inertia": inertia,
        "terms": {joint: list(names) for joint, names in terms.items()},
    }
    first, tree = body.equation.first_joint_row, body.equation.tree
    places = [
        Place(first + joint, TERM_UNITS["offset"][int(tree.slides[joint])], joint=name)
        for joint, name in enumerate(tree.names)
        if name in terms
    ]
    parameters = _parameters(fit, trust, terms, fitted, robot)
    notes = [*said, *choice]
    return result_of(
        JOINTS_SCHEMA, made, fit, trust, fitted, unseen, places, chosen, parameters=parameters, notes=notes
    )


def _given(made: WholeLogs, inertia: Inertia, progress: Progress) -> tuple[Array | None, list[Note]]:
    """The inertial parameters that eq. 3 is to take as they are, if any: the URDF's, or those of eq. 2."""
    body = made.body
    if inertia == "together":
        return None, []
    if inertia == "known":
        text = f"inertias taken from the URDF as known: {UNCOUNTED}"
        return body.prior.cad, [Note("inertia_known", "info", text)]
    recordings = [inertial_samples(body, whole, made.calibration) for whole in made.fitted]
    fit = RegularisedProblem.of(body.equation, body.base, body.prior, recordings).solve(progress)
    text = f"inertias identified first, from the base rows (eq. 2): {UNCOUNTED}"
    return fit.inertial, [Note("inertia_first", "info", text), *fit_notes(fit)]


def _chosen(
    made: WholeLogs, inertial: Array | None, progress: Progress
) -> tuple[dict[str, tuple[str, ...]], RegularisedFit, list[Note]]:
    """Terms of every joint that takes part, and the fit with them; inertial: given parameters, if any."""
    body = made.body
    measured = _measured_joints(made)
    described = body.robot.joints
    tried, errors = [], []
    for further in FURTHER:
        default = (*FRICTION, *further)
        terms = {name: described[name].terms if name in described else default for name in measured}
        recordings = [joint_samples(body, whole, made.calibration, terms) for whole in made.fitted]
        problem = RegularisedProblem.of(body.equation, body.base, body.prior, recordings)
        fit = problem.solve(progress) if inertial is None else problem.with_known(inertial)
        if not fit.held_out or all(name in described for name in measured):
            return terms, fit, []
        tried.append((default, terms, fit))
        errors.append(_held_out(fit, tried[0][2]))
    default, terms, fit = tried[as_good(errors).index(True)]
    beside = [f"{np.sqrt(np.mean(error)):.4g} with {' and '.join(further) or 'no more'}"
              for error, further in zip(errors, FURTHER, strict=True)]  # fmt: skip
    text = f"joints that the robot file does not describe: {', '.join(default)} (held-out error {', '.join(beside)})"
    return terms, fit, [Note("terms", "info", text)]


def _held_out(fit: RegularisedFit, reference: RegularisedFit) -> Array:
    """Each fold's held-out error of a fit, where it is smallest, in the weights of another: so both compare."""
    ratio = np.mean([(reference.weights[row] / fit.weights[row]) ** 2 for row in fit.weights])
    return np.asarray(min((tried.errors for tried in fit.held_out), key=np.mean) * ratio)


def _measured_joints(made: WholeLogs) -> tuple[str, ...]:
    """Passive joints, and those with effort in every log to fit; what is fitted must also be there to be scored."""
    joints = made.body.robot.joints
    passive = {name for name, joint in joints.items() if joint.passive}
    names = tuple(
        name
        for name in made.body.equation.tree.names
        if name in passive or all(name in whole.efforts for whole in made.fitted)
    )
    if not names:
        valid = "joint.<joint>.effort, or passive: true in the robot file"
        raise DataError("holds no joint torques", path=made.fitted[0].log.source, valid=valid)
    for whole in made.unseen:
        for name in names:
            if name not in passive and name not in whole.efforts:
                raise DataError("is missing", path=whole.log.source, column=f"joint.{name}.effort")
    return names


def _parameters(
    fit: RegularisedFit,
    trust: Uncertainty,
    terms: Mapping[str, tuple[str, ...]],
    recordings: Sequence[Samples],
    robot: RobotModel,
) -> tuple[JointParameter, ...]:
    """Every term of every joint."""
    rows, above = [], _above_sensors(robot)
    for joint, name in enumerate(fit.equation.tree.names):
        if name not in terms:
            continue
        row, slides = fit.equation.first_joint_row + joint, int(fit.equation.tree.slides[joint])
        torque = float(np.sqrt(np.mean(np.concatenate([one.measured[row] for one in recordings]) ** 2)))
        still = all(np.ptp(one.motion.positions[:, joint]) < 1e-3 for one in recordings)
        intervals = [
            interval95(float(value), float(std), trust.freedom)
            for value, std in zip(fit.extras[row], trust.extras[row], strict=True)
        ]
        by_held_out = robot.base != "fixed" and name not in robot.joints
        verdicts = _judge_all(terms[name], fit.extras[row], intervals, torque, still)
        found = zip(terms[name], fit.extras[row], trust.extras[row], intervals, verdicts, strict=True)
        for term, value, std, interval, (verdict, reason) in found:
            if verdict == "usable" and term == "offset" and name in above:
                verdict, reason = "weak", SENSORS_ZERO
            if verdict == "usable" and term not in FRICTION and by_held_out:
                verdict, reason = "weak", SENSORS_ERRORS
            rows.append(
                JointParameter(
                    name, term, TERM_UNITS[term][slides], float(value), float(std), interval, verdict, reason
                )
            )
    return tuple(rows)


def _above_sensors(robot: RobotModel) -> frozenset[str]:
    """The joints between the root link of a floating robot and its feet's force sensors."""
    if robot.base == "fixed":
        return frozenset()
    model = robot.model
    sensors = [robot.frame(foot.wrench.placement)[0] for foot in robot.feet.values()]
    return frozenset(model.names[joint] for sensor in sensors for joint in model.supports[sensor])


def _judge_all(
    terms: Sequence[str], values: Array, intervals: Sequence[tuple[float, float]], torque: float, still: bool
) -> list[tuple[Verdict, str]]:
    """Verdict and reason of each term of a joint. Beside one that is surely negative and cannot be, none is usable:
    what is taken for it is taken for the others too."""
    known = list(zip(terms, values, intervals, strict=True))
    verdicts = [_judge(term, float(value), interval, torque, still) for term, value, interval in known]
    amiss = [term for term, _, interval in known if term in POSITIVE and interval[1] < 0]
    if not amiss:
        return verdicts
    beside = f"beside it the joint's {amiss[0]} is negative, which is impossible"
    return [("weak", beside) if verdict == "usable" else (verdict, reason) for verdict, reason in verdicts]


def _judge(
    term: str, value: float, interval: tuple[float, float], torque: float, still: bool
) -> tuple[Verdict, str]:
    half = (interval[1] - interval[0]) / 2
    if still and term != "offset":
        return "unidentifiable", "the joint hardly moves"
    if term in POSITIVE and value <= 0:
        impossible = interval[1] < 0
        return (
            "unidentifiable",
            "negative, which is impossible" if impossible else "zero lies in the interval",
        )
    if half <= USABLE_SHARE * abs(value):
        return "usable", "the interval is narrow"
    if term == "offset" and half <= OFFSET_SHARE * torque:
        return "usable", "the interval is narrow beside the joint's torque"
    if interval[0] <= 0 <= interval[1]:
        return "unidentifiable", "zero lies in the interval"
    return "weak", f"the interval is {100 * half / abs(value):.0f} % of the value to each side"
