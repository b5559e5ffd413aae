"""Careless changes of how motions are designed: a robot would fall, or promise what it cannot keep."""

from __future__ import annotations

from mutant import Mutant

QUICK = (
    "design/test_soft_feet.py",
    "design/test_information.py",
    "design/test_search.py",
    "design/test_reach.py",
    "design/test_family.py",
)

DESIGNED_MOTIONS = (
    Mutant(
        "design/soft_feet.py", "gravity holds the robot upright",
        "- (weight if axis else 0.0)", "+ (weight if axis else 0.0)", QUICK,
    ),
    Mutant(
        "design/soft_feet.py", "a sway to the left loads the right foot",
        "np.array([1.0, y, -x]), moved", "np.array([1.0, -y, -x]), moved", QUICK,
    ),
    Mutant(
        "design/soft_feet.py", "damping without the rate", "bush.stiffness + bush.damping * s", "bush.stiffness", QUICK,
    ),
    Mutant(
        "design/soft_feet.py", "one foot of two is asked for", "self.height / len(self.places)", "self.height", QUICK,
    ),
    Mutant(
        "design/soles.py", "centres of pressure to the other side in pitch",
        "[[-1.0], [1.0]]", "[[-1.0], [0.0]]", QUICK,
    ),
    Mutant(
        "design/reach.py", "feet push the same way",
        "place, :, :] - torque[..., other", "place, :, :] + torque[..., other", ("design/test_linear.py",),
    ),
    Mutant(
        "design/information.py", "an unknown element costs nothing",
        "whole[..., :2, :2] - across", "whole[..., :2, :2] - 0 * across", QUICK,
    ),
    Mutant(
        "design/information.py", "a delay that is unsure costs no damping",
        "np.hypot(widths[..., 1], (late * firm", "np.hypot(widths[..., 1], (0 * late * firm", QUICK,
    ),
    Mutant(
        "design/information.py", "load that goes along with the other foot's",
        "load[..., 0, :] - load[..., -1, :]", "load[..., 0, :] + load[..., -1, :]", QUICK,
    ),
    Mutant(
        "twin/presets.py", "a large robot on a small one's rubber",
        "sized_for(robot) * torque", "torque", ("twin/sensing/test_sensors.py",),
    ),
    Mutant(
        "design/family.py", "the mirror image keeps the sign", "+= sign * halves[1][row]", "+= halves[1][row]", QUICK,
    ),
    Mutant(
        "design/information.py", "a number out of reach is all that counts",
        "BEYOND * np.maximum", "1.0 * np.maximum", QUICK,
    ),
    Mutant(
        "design/information.py", "a lean that a drift hides counts",
        "drift_basis(reach.firm_time)", "drift_basis(reach.firm_time)[:, :1]", QUICK,
    ),
    Mutant(
        "design/rehearsals/attempt.py", "what fails far from its limit keeps its share",
        "change * np.minimum(shares, foretold)", "change * shares", ("design/test_rehearsals.py",),
    ),
    Mutant(
        "design/information.py", "a model that knows every amplitude", "MODEL_ERROR**2 /", "0 * MODEL_ERROR /", QUICK,
    ),
    Mutant(
        "design/information.py", "more than enough counts as what is missing", "ENOUGH * widths", "widths", QUICK,
    ),
    Mutant(
        "design/information.py", "a second motion gives up as the first did", "np.inf if np.any(known) else", "", QUICK,
    ),
    Mutant(
        "design/search.py", "a way that is far behind is followed", "key=lambda way: way.least)[:FOLLOWED]",
        "key=lambda way: -way.least)[:FOLLOWED]", QUICK,
    ),
    Mutant(
        "design/known.py", "a weak stiffness is no softer", "return SPRING * low, high", "return low, high",
        ("design/test_known.py",),
    ),
    Mutant(
        "design/known.py", "an element counts as spring", "+ sure - element[", "+ sure - 0 * element[",
        ("design/test_known.py",),
    ),
    Mutant(
        "design/rehearsals/attempt.py", "joints move no less", "SMALLER * min(self.others, self.reach.used_over_none",
        "SMALLER * max(self.others, self.reach.used_over_none", ("design/test_rehearsals.py",),
    ),
    Mutant(
        "design/writing/foretold.py", "what the first motion showed is weak", "if weak and (foot, axis) in before:",
        "if weak and not before:", ("design/test_foretold.py",),
    ),
    Mutant(
        "design/search.py", "all beginnings have the same frequencies",
        "default_rng([seed, place])", "default_rng(seed)", QUICK,
    ),
    Mutant(
        "design/writing/promised.py", "the widest draw is not promised",
        "for (low, high), value in known)", "for (low, high), value in known[:1])", ("design/test_promised.py",),
    ),
    Mutant(
        "design/writing/promised.py", "a play is off by the mean", "np.mean(np.square(found))", "np.mean(found) ** 2",
        ("design/test_promised.py",),
    ),
    Mutant(
        "design/writing/foretold.py", "plays go with what is missing", "(off / wanted) ** 2", "(off / wanted)",
        ("design/test_foretold.py",),
    ),
    Mutant(
        "logs/save_mc_rtc.py", "the base turned the other way", "np.swapaxes(base[:, :3, :3], 1, 2)", "base[:, :3, :3]",
        ("design/test_controllers.py",),
    ),
)  # fmt: skip
