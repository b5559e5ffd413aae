"""Results out: the files that simulators and controllers read. One file a target.

    plantar.export("out/result.json", "mjcf", "robot_on_bushes.xml", model="robot.xml")

A result of `identify feet` goes to any target of `TARGETS`; a result of `identify inertia` to `urdf`.
"""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

from plantar.errors import ExportError
from plantar.exporters.bush import check_swing, feet_of_result
from plantar.exporters.comment import joints_note
from plantar.exporters.job import LEAST_LOAD, Job, Stance, asked
from plantar.exporters.source import ResultInput, open_result, robot_urdf
from plantar.files import write_text
from plantar.notes import Note, Notes, unique

# Target -> (module of this package, what it writes).
TARGETS: dict[str, tuple[str, str]] = {
    "mjcf": ("mjcf.target", "MuJoCo model (MJCF): bush joints and a light sole in each foot"),
    "mujoco-contact": ("contact.target", "MuJoCo model (MJCF): points under each foot with fitted solref"),
    "drake-contact": (
        "contact.drake",
        "SDFormat for Drake: points with stiffness and damping under each foot",
    ),
    "bullet-contact": (
        "contact.bullet",
        "URDF for Bullet: points with stiffness and damping under each foot",
    ),
    "physx-contact": ("contact.physx", "USD layer over your stage: points with PhysX' compliant contact"),
    "sdf": ("sdf.target", "SDFormat model: prismatic and revolute joints with spring and damper"),
    "urdf": ("urdf.target", "URDF with Gazebo's spring tags, or the inertias of a plantar.inertia/1"),
    "drake": ("sdf.drake", "SDFormat for Drake: free bush joints under a drake:linear_bushing_rpy"),
    "usd": ("usd.target", "USD layer (.usda) with UsdPhysics joint drives, per degree, as Isaac reads them"),
    "mc_rtc": ("mc_rtc", "mc_rtc robot module: the JSON entry 'flexibilities'"),
    "openhrp": ("openhrp", "OpenHRP and hrpsys: configuration of the bush customizer"),
    "choreonoid": ("choreonoid", "Choreonoid: the YAML entry 'bush' of a body customizer"),
    "kinetics_observer": ("kinetics_observer", "Kinetics Observer: stiffness and damping of contacts"),
    "randomization": ("randomization", "YAML of means, deviations and correlations, to train with"),
    "yaml": ("plain", "YAML with every number, its unit and its interval"),
}

# Targets in which a bush is a joint for each axis.
WITH_JOINTS = frozenset({"mjcf", "sdf", "urdf", "drake", "usd"})


def export(
    result: ResultInput,
    target: str,
    out: str | os.PathLike[str],
    model: str | os.PathLike[str] | None = None,
    *,
    with_offset: bool = False,
    swing: float | None = None,
    hysteresis: bool = False,
    pivot: str = "ground",
    least_load: float = LEAST_LOAD,
) -> tuple[Note, ...]:
    """Hand a result to a simulator or controller: springs and dampers in its own format and units.

    Args:
        result: what `identify_feet` or `identify_inertia` found, or the path of its `result.json`.
        target: one of `TARGETS`: mjcf, mujoco-contact, drake-contact, bullet-contact, physx-contact, sdf, urdf, drake,
            usd, mc_rtc, openhrp, choreonoid, kinetics_observer, randomization or yaml; for inertias urdf.
        out: the file to write.
        model: an existing robot model of that format to extend (MJCF, SDFormat, URDF, USD; a URDF works for MJCF and
            SDFormat too); the result's own URDF where left out, for USD a layer to reference.
        with_offset: the springs rest at -offset/K; else at 0, since the offset is mostly the sensors' zero.
        swing: where the rubber has hysteresis and the target has none, the spring and damper of motions with this
            amplitude are written [rad]; None takes the median amplitude of the identified motions.
        hysteresis: for mujoco-contact: leave slip and tipping, which contact points cannot model, to
            `plantar.FootHysteresis`, to be called in the simulation's loop. The joints of mjcf have the slip anyway.
        pivot: for mujoco-contact: what feet turn about: "ground", or "bush", the bush centre, as the robot's feet do.
            With "bush" the robot stands lower by the height of the bush over the sole.
        least_load: for mujoco-contact: share of the robot's weight below which a foot is soft along z, 0.05 to 0.5. A
            smaller share suits feet that are lightly loaded, but K then holds up to a smaller angle only.

    Returns:
        What the target could not hold, as notes.

    Raises:
        ExportError: an unknown target, a swing that is no angle, a hysteresis, pivot or least load that the target does
            not take, a result without what the target needs, a model without the ankle.

    Example:
        >>> import plantar
        >>> result = plantar.FeetResult.load("out/feet")
        >>> notes = plantar.export(result, "urdf", "out/robot_on_bushes.urdf")
        >>> "LLEG_BUSH_PITCH" in open("out/robot_on_bushes.urdf").read()
        True
    """
    check_swing(swing)
    stance = Stance(pivot, least_load)
    if target not in TARGETS:
        raise ExportError(f"'{target}' is not a target", valid=", ".join(TARGETS))
    data, base = open_result(result)
    path = Path(out)
    given = None if model is None else Path(model)
    if data.get("schema") == "plantar.inertia/1":
        if target != "urdf":
            raise ExportError("cannot hold a result of plantar.inertia/1", value=target, valid="urdf")
        if given is None and "robot_model" not in data:
            raise ExportError("the result names no URDF", valid="--model with the robot's URDF")
        from plantar.exporters.urdf.inertia import with_inertial_parameters

        text, notes = with_inertial_parameters(data, given or robot_urdf(data, base))
    else:
        module = import_module(f"plantar.exporters.{TARGETS[target][0]}")
        hysteresis = asked(module, target, hysteresis, swing, stance)
        feet, remarks = feet_of_result(
            data, base, with_offset=with_offset, hysteresis=hysteresis, swing=swing
        )
        if given is None and getattr(module, "EXTENDS", False):
            given = robot_urdf(data, base)
        takes_model = getattr(module, "EXTENDS", False) or getattr(module, "OPTIONAL_MODEL", False)
        if given is not None and not takes_model:
            raise ExportError("this target takes no model", value=target, valid="no --model")
        said = Notes()
        text = module.write(Job(data, feet, given, path, with_offset, remarks, stance, hysteresis), said)
        notes = (*remarks, *said, *([joints_note(feet)] if target in WITH_JOINTS else []))
    write_text(path, text)
    return unique(notes)
