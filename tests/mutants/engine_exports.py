"""Careless changes of what goes to simulators: slips in MuJoCo, overs on a stage, comparisons up to a fall."""

from __future__ import annotations

from mutant import Mutant

ENGINE_EXPORTS = (
    Mutant(
        "exporters/spring.py", "the slip's spring is its torque times its angle",
        "return self.torque / self.angle", "return self.torque * self.angle", ("exporters/test_mjcf_hysteresis.py",),
    ),
    Mutant(
        "exporters/mjcf/hysteresis.py", "a slip of an earlier export stays",
        "if spring.slip is not None else (0.0, 0.0)", "if spring.slip is not None else (5.0, 500.0)",
        ("exporters/test_mjcf_hysteresis.py",),
    ),
    Mutant(
        "exporters/mjcf/hysteresis.py", "the tendon rests at the slip angle",
        '"springlength": "0"', '"springlength": "0.01"',
        ("exporters/test_mjcf_hysteresis.py",),
    ),
    Mutant(
        "exporters/mjcf/hysteresis.py", "dry friction as soft as MuJoCo's own",
        "IMPERFECT: Final = 1e-4", "IMPERFECT: Final = 1e-1", ("exporters/test_mjcf_hysteresis.py",),
    ),
    Mutant(
        "exporters/mjcf/target.py", "keyframes without the slip's joint",
        "for name in (foot.joint(spring.axis), slip_joint(foot, spring))]", "for name in (foot.joint(spring.axis),)]",
        ("exporters/test_mjcf_hysteresis.py",),
    ),
    Mutant(
        "exporters/randomization.py", "ranges of the linear equivalent for a model with slip",
        "HYSTERESIS = True", "HYSTERESIS = False", ("exporters/test_randomization.py",),
    ),
    Mutant(
        "exporters/usd/conventions.py", "stiffness per radian in a drive that counts degrees",
        "PER_DEGREE = math.pi / 180", "PER_DEGREE = 1.0", ("exporters/test_usd.py", "exporters/test_export.py"),
    ),
    Mutant(
        "exporters/usd/over.py", "the ankle's turn in the world is left out",
        "turn = place[:3, :3] @ foot.rotation", "turn = foot.rotation.T", ("exporters/test_usd.py",),
    ),
    Mutant(
        "exporters/usd/over.py", "mass comes in from nowhere",
        "attribute.Set(old - mass)", "attribute.Set(old)", ("exporters/test_usd.py",),
    ),
    Mutant(
        "exporters/usd/stage.py", "the shapes that stood on the ground go on touching it",
        "CreateCollisionEnabledAttr(False)\n\n\ndef with_scene",
        "CreateCollisionEnabledAttr(True)\n\n\ndef with_scene",
        ("exporters/test_usd.py",),
    ),
    Mutant(
        "exporters/contact/hysteresis.py", "the slip pushes a rolled foot further over",
        "-math.asin(y), pitch]", "math.asin(y), pitch]", ("exporters/test_contact_hysteresis.py",),
    ),
    Mutant(
        "exporters/contact/hysteresis.py", "a foot in the air remembers how it stood",
        "                foot.law.forget()\n", "", ("exporters/test_contact_hysteresis.py",),
    ),
    Mutant(
        "exporters/contact/hysteresis.py", "the horizon instead of the ground",
        "foot.wrench(normal @ turn,", "foot.wrench(turn[2],", ("exporters/test_contact_hysteresis.py",),
    ),
    Mutant(
        "exporters/contact/hysteresis.py", "the points' own push comes on top",
        "(force - pushes.sum()) * normal", "force * normal",
        ("exporters/test_contact_hysteresis.py",),
    ),
    Mutant(
        "exporters/contact/bush_on_sole.py", "nothing ever yields",
        "self.yielded[place] = float(bent[1 + place])", "self.yielded[place] = 0.0 * float(bent[1 + place])",
        ("exporters/test_contact_hysteresis.py",),
    ),
    Mutant(
        "exporters/contact/bush_on_sole.py", "a sole that never tips",
        "(self._walls @ wrench).min() >= 0", "(self._walls @ wrench).min() >= -1e9",
        ("exporters/test_bush_on_sole.py",),
    ),
    Mutant(
        "exporters/contact/bush_on_sole.py", "rubber that yields by the tipped foot's angle",
        "strain = bent[1 + place]", "strain = deflection[1 + place]", ("exporters/test_bush_on_sole.py",),
    ),
    Mutant(
        "exporters/bush.py", "a pivot as far under the sole as the bush is above it",
        "sole=foot.sole + foot.sole_depth", "sole=foot.sole - foot.sole_depth",
        ("exporters/test_contact_hysteresis.py",),
    ),
    Mutant(
        "exporters/contact/springs.py", "the ground's push does not lean with the sole",
        "return foot.turning(axis)[0] - sum(", "return foot.turning(axis)[0] - 0 * sum(",
        ("exporters/test_contact_files.py",),
    ),
    Mutant(
        "exporters/contact/springs.py", "a sphere's radius is forgotten",
        "foot.depth + p.lower - RADIUS) for", "foot.depth + p.lower) for", ("exporters/test_contact_files.py",),
    ),
    Mutant(
        "exporters/contact/bullet.py", "the middle point rubs",
        "0.0 if point.middle else outer", "outer", ("exporters/test_contact_files.py",),
    ),
    Mutant(
        "exporters/contact/drake.py", "a damping for a relaxation time",
        '"relaxation_time", point.damping / point.stiffness', '"relaxation_time", point.damping',
        ("exporters/test_contact_files.py",),
    ),
    Mutant(
        "exporters/spring.py", "a slip's damper at another rate",
        "(math.pi * SWAY * swing**2)", "(math.pi * swing**2)", ("exporters/test_contact.py",),
    ),
    Mutant(
        "exporters/kinetics_observer.py", "roll and pitch change places on the way back",
        '("roll", "ang", 0), ("pitch", "ang", 1)', '("roll", "ang", 1), ("pitch", "ang", 0)',
        ("exporters/test_controller_files.py",),
    ),
    Mutant(
        "twin/replay.py", "a sole starts in the ground",
        "root[2, 3] -= min(0.0, *heights)", "root[2, 3] -= 0.0", ("comparison/test_compare.py",),
    ),
    Mutant(
        "comparison/compare.py", "the fall itself is scored",
        "BEFORE: Final = 1.0", "BEFORE: Final = 0.0", ("comparison/test_compare.py",),
    ),
    Mutant(
        "exporters/sdf/target.py", "what hangs behind a sensor stays above the bush",
        "            elif child not in above:\n                above.append(child)\n", "",
        ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "exporters/urdf/target.py", "shapes of links fixed to the ankle stay above the bush",
        "for name, place in above:\n            for said", "for name, place in above[:1]:\n            for said",
        ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "exporters/bush.py", "a second chain beside a bush that lacks an axis",
        "if found and missing:", "if found and missing and not found:", ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "exporters/sdf/drake.py", "the bush's joints are motors",
        '"effort").text = "0"', '"effort").text = "1"', ("exporters/test_drake_bushing.py",),
    ),
    Mutant(
        "exporters/mjcf/file.py", "the whole scene stands on the feet",
        "float(self.model.body_subtreemass[root])", "float(self.model.body_subtreemass[0])",
        ("exporters/test_contact_files.py",),
    ),
    Mutant(
        "exporters/contact/physx.py", "the whole stage stands on the feet",
        "tied, before = {ankle.GetPath()}, 0", "tied, before = set(bodies), 0",
        ("exporters/test_contact_files.py",),
    ),
)  # fmt: skip
