"""What logs call the URDF's joints, guessed from both lists of names."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from example_robots import G1, TALOS, model
from plantar.robot.joint_names import JointNames, propose_names, propose_order

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


@pytest.mark.parametrize(
    "called",
    [
        lambda name: f"/g1/{name.removesuffix('_joint')}",
        lambda name: f"g1/{name.upper()}",
        lambda name: name.replace("left_", "l_").replace("right_", "r_"),
        lambda name: name.replace("_", "").upper(),
        lambda name: name.replace("left_", "L").replace("right_", "R"),
        lambda name: f"m_{name.replace('_', '')}",
    ],
)
def test_several_changes_at_once_are_seen_through(called: Callable[[str], str]) -> None:
    recorded = [called(name) for name in G1_JOINTS]
    names = propose_names(G1_JOINTS, sorted(recorded))
    assert names is not None
    assert [names.in_log(name) for name in G1_JOINTS] == recorded


@pytest.mark.parametrize("called", ["{}", "motor_{}", "q{}_pos", "joint{:02d}"])
@pytest.mark.parametrize("first", [0, 1])
def test_numbers_are_taken_in_the_urdfs_order(called: str, first: int) -> None:
    recorded = [called.format(first + place) for place in range(len(G1_JOINTS))]
    names = propose_order(G1_JOINTS, sorted(recorded))
    assert names is not None
    assert [names.in_log(name) for name in G1_JOINTS] == recorded


def test_other_numbers_say_nothing_of_the_order() -> None:
    count = len(G1_JOINTS)
    assert propose_order(G1_JOINTS, [f"q{place}" for place in range(count - 1)]) is None, "one is missing"
    assert propose_order(G1_JOINTS, [f"q{place}" for place in range(2, count + 2)]) is None, "they start at 2"
    assert propose_order(G1_JOINTS, [f"q{2 * place}" for place in range(count)]) is None, "with gaps"
    assert propose_order(G1_JOINTS, TALOS_JOINTS[:count]) is None
    assert "'0'" in str(propose_order(G1_JOINTS, [str(place) for place in range(count)])), (
        "YAML's text, not number"
    )
