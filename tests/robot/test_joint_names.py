"""What logs call the URDF's joints, guessed from both lists of names."""

from __future__ import annotations

import pytest

from example_robots import G1, TALOS, model
from plantar.robot.joint_names import JointNames, propose_names

TALOS_JOINTS = list(model(TALOS).names)[1:]
G1_JOINTS = list(model(G1).names)[1:]


def talos_words(name: str) -> str:
    """leg_left_1_joint as Leg1Left."""
    part, side, number, _ = name.split("_")
    return f"{part.title()}{number}{side.title()}"


@pytest.mark.parametrize(
    ("joints", "recorded"),
    [
        (TALOS_JOINTS, [f"talos/{name}" for name in TALOS_JOINTS]),
        (TALOS_JOINTS, [f"{name}_position" for name in TALOS_JOINTS]),
        ([f"talos::{name}" for name in TALOS_JOINTS], TALOS_JOINTS),
        (TALOS_JOINTS, [name.upper() for name in TALOS_JOINTS]),
        (TALOS_JOINTS, ["_".join(reversed(name.split("_"))) for name in TALOS_JOINTS]),
        (
            [name for name in TALOS_JOINTS if name.startswith("leg")],
            [talos_words(name) for name in TALOS_JOINTS if name.startswith("leg")],
        ),
        (["left_knee_joint", "right_knee_joint"], ["LKnee", "RKnee"]),
    ],
)
def test_a_naming_is_proposed_that_reaches_every_joint(joints: list[str], recorded: list[str]) -> None:
    names = propose_names(joints, recorded)
    assert names is not None
    assert sorted(names.in_log(joint) for joint in joints) == sorted(recorded)


def test_no_naming_is_proposed_for_another_robot() -> None:
    assert propose_names(TALOS_JOINTS, G1_JOINTS) is None
    assert propose_names(G1_JOINTS, TALOS_JOINTS) is None
    assert propose_names(TALOS_JOINTS, TALOS_JOINTS) is None, "nothing to rename"
    assert propose_names([], ["a"]) is None


def test_long_namings_are_cut_in_messages() -> None:
    names = JointNames(renamed={f"j{k}": f"k{k}" for k in range(5)})
    assert str(names) == "joint_names: {renamed: {j0: k0, j1: k1, j2: k2, ...}}"
    assert names.entry() == {"renamed": dict(names.renamed)}
