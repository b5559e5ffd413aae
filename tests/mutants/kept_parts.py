"""Careless changes in parts that no whole output held before: designs, replays, points, ends of commands."""

from __future__ import annotations

from mutant import Mutant

KEPT_PARTS = (
    Mutant(
        "exporters/spring.py",
        "a swing of more than a radian is a swing",
        "return swing if 0 < swing < 1 else None",
        "return swing",
        ("exporters/test_edges.py",),
    ),
    Mutant(
        "exporters/bush.py",
        "a foot without a spring about an axis is turned about it",
        'rest.get("roll", 0.0)',
        'rest.get("roll", 1.0)',
        ("exporters/test_edges.py",),
    ),
    Mutant(
        "exporters/mjcf/file.py",
        "a sole may touch the toes of its ankle",
        "        near |= {other for other in others if int(weld[model.body_parentid[other]]) == mine}\n",
        "",
        ("exporters/test_bush_elements.py",),
    ),
    Mutant(
        "exporters/mjcf/target.py",
        "a keyframe is no longer than what it names",
        'getattr(before.model, f"key_{attribute}")[place]',
        'np.array(key.get(attribute, "").split(), float)',
        ("exporters/test_bush_elements.py",),
    ),
    Mutant(
        "fleet/inertia.py",
        "the last reason is told of many",
        "reason = reason or str(error)",
        "reason = str(error)",
        ("fleet/test_inertia.py",),
    ),
    Mutant(
        "cli/identify/joints.py",
        "joints are never silent",
        "json=json, quiet=quiet, beside=[URDF]",
        "json=json, beside=[URDF]",
        ("cli/test_kept.py",),
    ),
    Mutant(
        "cli/fleet/inertia.py",
        "a fleet's URDF is not named",
        "quiet=quiet, beside=[URDF]",
        "quiet=quiet",
        ("fleet/test_inertia.py",),
    ),
    Mutant(
        "cli/compare.py",
        "a sole that tips is no warning",
        'screen.print(text, markup=False, style="yellow")\n        for one in scores',
        "screen.print(text, markup=False)\n        for one in scores",
        ("cli/test_ends_of_commands.py",),
    ),
    Mutant(
        "cli/demo.py",
        "a warning of the demo is markup",
        'out.print(f"note: {note.text}", markup=False, style="yellow")',
        'out.print(f"note: {note.text}", style="yellow")',
        ("cli/test_ends_of_commands.py",),
    ),
    Mutant(
        "design/writing/outputs.py",
        "who watched for touching did not",
        '"checked": found.pairs > 0',
        '"checked": found.pairs < 0',
        ("design/test_kept.py",),
    ),
    Mutant(
        "design/information.py",
        "a short bend widens half as steeply",
        "missing ** (2 * STEEP)",
        "missing**STEEP",
        ("design/test_kept.py",),
    ),
    Mutant(
        "fleet/plan.py",
        "a name's seconds are lost",
        "int(second or 0)",
        "0",
        ("fleet/test_plan.py",),
    ),
    Mutant(
        "sensors/tilt_error.py",
        "an attitude is put right in place",
        "right = orientation.copy()",
        "right = orientation",
        ("sensors/test_tilt_error.py",),
    ),
    Mutant(
        "motions/footsteps.py",
        "the last step goes on",
        "        if not last:\n            path",
        "        if True:\n            path",
        ("motions/test_kept.py",),
    ),
    Mutant(
        "twin/replay.py",
        "a servo's give is taken off",
        "positions[:, place] += effort",
        "positions[:, place] -= effort",
        ("twin/test_kept.py",),
    ),
    Mutant(
        "contact/balance.py",
        "a wrench is not moved to the world's origin",
        "torque + np.cross(to_world[:3, 3], force)",
        "torque",
        ("contact/test_kept.py",),
    ),
    Mutant(
        "exporters/contact/target.py",
        "points stand in the ankle and not in the body that holds them",
        "foot.rotation @ centre + foot.centre",
        "centre + foot.centre",
        ("exporters/test_kept.py",),
    ),
)
