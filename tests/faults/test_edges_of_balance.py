"""What is said of wrenches that do not balance gravity, at each limit: a stub has the misfits and the leans."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

from plantar.faults import standing
from plantar.faults.stance import StanceSides
from plantar.faults.stance_changes import StanceChanges, TurnedWrench
from plantar.notes import Finding

UP = np.tile([0.0, 0.0, 1.0], (10, 1))


@dataclass
class Stub:
    """A stance of a misfit [m] and a lean [deg]; `exchanged`: the misfit with the feet's wrenches exchanged,
    `world`: with them read as in the world's axes."""

    misfit: float = 0.0
    lean: float = 0.0
    exchanged: float = 10.0
    world: float = 10.0
    torques: bool = False
    tilt: np.ndarray = field(default_factory=lambda: UP)
    turn: float = 0.0
    moves: float = 0.1
    below: float = 10.0
    imu = SimpleNamespace(name="chest")
    # Of which SHIFTED is 3 mm.
    robot = SimpleNamespace(
        feet={"left": SimpleNamespace(sole=SimpleNamespace(polygon=[[0.3, 0.1], [-0.3, -0.1]]))}
    )

    def sides(self) -> StanceSides:
        arms = np.zeros((10, 2, 6, 3))
        along = np.linspace(1 - self.moves, 1 + self.moves, 10)  # what moves is 5/9 of `moves`
        arms[:, 0, 4 if self.torques else 1, 0] = self.misfit * along
        lean = np.radians(self.lean)
        push = np.tile([np.sin(lean), 0.0, np.cos(lean)], (10, 1)) if self.tilt is UP else self._turned()
        return StanceSides(arms, self.tilt, push)

    def _turned(self) -> np.ndarray:
        c, s = np.cos(np.radians(self.turn)), np.sin(np.radians(self.turn))
        return np.asarray(self.tilt @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))

    def exchanged_wrenches(self) -> Stub:
        return Stub(self.exchanged)

    def world_wrenches(self) -> Stub:
        return Stub(self.world)

    def sole_wrenches(self) -> Stub:
        return Stub(self.below)


def said(
    monkeypatch: pytest.MonkeyPatch,
    stance: Stub,
    left: dict[str, float] | None = None,
    joints: dict[str, float] | None = None,
    pair: str | None = None,
    turned: TurnedWrench | None = None,
    unit: tuple[Finding, ...] = (),
) -> Finding | None:
    """The finding, where `left` and `joints` are the misfits with a component or a joint reversed."""
    monkeypatch.setattr(standing, "stance_of", lambda *_: stance)
    monkeypatch.setattr(StanceChanges, "_reversed_joints", lambda _: joints or {})
    monkeypatch.setattr(StanceChanges, "_reversed_components", lambda _: left or {})
    monkeypatch.setattr(StanceChanges, "misread_joints", lambda *_: {"exchanged": pair} if pair else {})
    monkeypatch.setattr(StanceChanges, "quarter_turn", turned)
    monkeypatch.setattr(standing, "torque_unit", lambda *_: unit)
    found = list(standing.check_balance(None, None))  # type: ignore[arg-type]
    assert len(found) <= 1
    return found[0] if found else None


@pytest.mark.parametrize(
    ("lean", "code", "fatal"),
    [(3.4, None, False), (3.6, "force_leans_little", False), (6.9, "force_leans_little", False),
     (7.1, "force_leans", False), (29.9, "force_leans", False), (30.1, "force_leans", True)],
)  # fmt: skip
def test_a_force_that_leans(
    monkeypatch: pytest.MonkeyPatch, lean: float, code: str | None, fatal: bool
) -> None:
    found = said(monkeypatch, Stub(lean=lean))
    assert (found and found.code) == code
    if found:
        assert found.fatal == fatal
        assert f"the ground's force leans {lean:.1f} deg from up (valid: below 3.5 deg;" in found.text
        assert found.text.startswith("columns 'imu.chest.*'")


@pytest.mark.parametrize(
    ("misfit", "code", "fatal", "text"),
    [(0.119, None, False, ""),
     (0.121, "balance", False, "columns 'wrench.*': balance gravity only to 12.1 cm about the URDF's centre of mass "
      "(valid: below 2 cm; check the encoders' zeros, where the wrenches are measured, and the masses)"),
     (1.49, "balance", False, "only to 149.0 cm"), (1.51, "balance", True, "only to 1.51 m about the centre of mass")],
)  # fmt: skip
def test_a_misfit_that_nothing_explains(
    monkeypatch: pytest.MonkeyPatch, misfit: float, code: str | None, fatal: bool, text: str
) -> None:
    found = said(monkeypatch, Stub(misfit))
    assert (found and found.code) == code
    assert not found or (found.fatal, text in found.text) == (fatal, True)


@pytest.mark.parametrize(
    ("misfit", "world", "turned", "told"),
    [(0.019, 0.0, None, False), (0.021, 0.0, None, True), (0.1, 0.049, None, True), (0.1, 0.051, None, False),
     (0.1, 0.029, 0.04, True), (0.1, 0.031, 0.04, False)],
)  # fmt: skip
def test_wrenches_in_the_world_s_axes(
    monkeypatch: pytest.MonkeyPatch, misfit: float, world: float, turned: float | None, told: bool
) -> None:
    """They leave less than half, and less than sensors that are turned by a quarter."""
    quarter = None if turned is None else TurnedWrench(turned, 1.0, 90, "columns 'wrench.*'")
    found = said(monkeypatch, Stub(misfit, world=world), turned=quarter)
    assert (found is not None and "read as in the world's axes" in found.text) == told


@pytest.mark.parametrize(("world", "code"), [(0.0349, "wrench_turned"), (0.051, "torque_unit")])
def test_no_unit_is_told_where_the_world_s_axes_explain_what_moves(
    monkeypatch: pytest.MonkeyPatch, world: float, code: str
) -> None:
    quarter = TurnedWrench(0.034, 1.0, 90, "columns 'wrench.*'")
    unit = Finding("torque_unit", "another unit", True)
    found = said(monkeypatch, Stub(0.1, world=world, exchanged=0.1), turned=quarter, unit=(unit,))
    assert found is not None
    assert found.code == code


def test_torques_in_millimetres_are_told_by_their_unit(monkeypatch: pytest.MonkeyPatch) -> None:
    found = said(monkeypatch, Stub(15.0, torques=True))
    assert found is not None
    assert (found.code, found.fatal) == ("torque_unit", True)
    assert "only to 15 m about the centre of mass (valid: torques in N·m; these look like N·mm)" in found.text


@pytest.mark.parametrize(("misfit", "left", "told"), [(0.019, 0.001, False), (0.021, 0.001, True), (0.1, 0.049, True),
                                                      (0.1, 0.051, False)])  # fmt: skip
def test_a_component_reversed_leaves_less_than_half(
    monkeypatch: pytest.MonkeyPatch, misfit: float, left: float, told: bool
) -> None:
    more = {"column 'b'": left + 0.09 * misfit, "column 'c'": left + 0.11 * misfit}
    found = said(monkeypatch, Stub(misfit), {"column 'a'": left, **more})
    assert (found is not None) == told
    if found:
        assert (found.code, found.fatal) == ("sign", False)
        text = f"column 'a' or column 'b': reversed, the wrenches balance gravity to {100 * left:.1f} cm instead of"
        assert found.text == f"{text} {100 * misfit:.1f} cm (valid: the signs of URDF and robot file)"


@pytest.mark.parametrize(
    ("misfit", "left", "lean", "fatal"),
    [
        (0.051, 0.005, 0.0, True),
        (0.049, 0.0048, 0.0, False),
        (0.1, 0.011, 0.0, False),
        (0.1, 0.02, 30.1, True),
    ],
)
def test_a_joint_reversed_is_certain_where_hardly_a_tenth_is_left(
    monkeypatch: pytest.MonkeyPatch, misfit: float, left: float, lean: float, fatal: bool
) -> None:
    """Of more than 5 cm, or where the force leans by more than any mount; below 5 cm joints are not asked at all."""
    joints = {"column 'joint.a.position'": left} if misfit > 0.05 else {}
    others = {"column 'b'": 0.9 * misfit, **({} if joints else {"x": left})}
    found = said(monkeypatch, Stub(misfit, lean), others, joints)
    assert found is not None
    assert (found.code, found.fatal) == ("sign", fatal)
    motors = (
        "valid: the signs of URDF and robot file, and the URDF's joints, not the motors of a parallel linkage"
    )
    assert not joints or found.text.endswith(f" cm ({motors})")


@pytest.mark.parametrize(
    ("misfit", "exchanged", "told"),
    [(0.019, 0.058, True), (0.019, 0.063, False), (0.0182, 0.01, True), (0.0178, 0.01, False)],
)
def test_feet_that_are_swapped_in_a_small_sway(
    monkeypatch: pytest.MonkeyPatch, misfit: float, exchanged: float, told: bool
) -> None:
    """Half of the misfit moves as read, and of what is left with the wrenches exchanged an eighteenth."""
    found = said(monkeypatch, Stub(misfit, exchanged=exchanged, moves=0.9))
    assert (found is not None and (found.code, found.fatal) == ("swapped_feet", True)) == told


@pytest.mark.parametrize(
    ("misfit", "below", "world", "told"),
    [
        (0.015, 0.046, 10.0, True), (0.015, 0.049, 10.0, False), (0.0121, 0.01, 10.0, True),
        (0.0119, 0.01, 10.0, False), (0.015, 0.04, 0.04, True), (0.03, 0.04, 0.079, False), (0.03, 0.04, 0.081, True),
        (0.049, 0.01, 10.0, True), (0.051, 0.01, 10.0, False),
    ],
)  # fmt: skip
def test_sensors_that_turn_with_the_soles(
    monkeypatch: pytest.MonkeyPatch, misfit: float, below: float, world: float, told: bool
) -> None:
    """Half of the misfit moves as read, of what is left in other axes an eighteenth. What the world's axes leave too is
    told as theirs, where the whole misfit shows them."""
    found = said(monkeypatch, Stub(misfit, below=below, world=world, moves=0.9))
    assert (found is not None and "turn with the soles" in found.text) == told


@pytest.mark.parametrize(
    ("misfit", "moving", "told"),
    [(0.015, 0.0026, True), (0.015, 0.0027, False), (0.0061, 0.001, True), (0.0059, 0.001, False)],
)
def test_sensors_that_are_turned_in_a_small_sway(
    monkeypatch: pytest.MonkeyPatch, misfit: float, moving: float, told: bool
) -> None:
    """Half of the misfit moves as read."""
    turned = TurnedWrench(misfit / 4, moving, 180, "columns 'wrench.left.*'")
    found = said(monkeypatch, Stub(misfit, moves=0.9), turned=turned)
    assert (found is not None and found.code == "wrench_turned") == told


@pytest.mark.parametrize(
    ("exchanged", "best", "said_too", "told"),
    [
        (0.049, np.inf, False, True),
        (0.051, np.inf, False, False),
        (0.04, 0.031, True, True),
        (0.04, 0.029, False, False),
    ],
)
def test_feet_that_are_swapped(
    monkeypatch: pytest.MonkeyPatch, exchanged: float, best: float, said_too: bool, told: bool
) -> None:
    """Exchanged they leave less than half, and hardly more than the best reversal, which is told beside."""
    found = said(
        monkeypatch, Stub(0.1, exchanged=exchanged), {"column 'a'": best} if np.isfinite(best) else {}
    )
    assert (found is not None and found.code == "swapped_feet") == told
    if found and told:
        assert found.fatal
        assert ("; or column 'a' is reversed" in found.text) == said_too


@pytest.mark.parametrize(("moving", "told"), [(0.008, True), (0.0085, True), (0.0088, False), (0.05, False)])
def test_a_load_in_one_hand_is_no_exchange_of_feet(
    monkeypatch: pytest.MonkeyPatch, moving: float, told: bool
) -> None:
    """Exchanged feet undo what is constant of it, and more of the misfit moves: SHIFTED more than as read."""
    stance = Stub(0.1, exchanged=0.01)
    other = SimpleNamespace(misfit=0.01, moving=moving)
    still = Stub.sides

    def sides(self: Stub) -> object:
        return other if self.misfit == other.misfit else still(self)

    monkeypatch.setattr(Stub, "sides", sides)
    assert stance.sides().moving == pytest.approx(0.1 * 0.1 * 5 / 9, rel=0.02)
    found = said(monkeypatch, stance)
    assert (found is not None and found.code == "swapped_feet") == told


def test_feet_that_are_swapped_in_a_small_sway_whatever_else_would_undo_what_is_constant(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Stub, "exchanged_wrenches", lambda _: Stub(0.011, moves=0.9))
    assert said(monkeypatch, Stub(0.019, moves=0.9), {"column 'a'": 0.001}) is None  # what moves stays
    monkeypatch.setattr(Stub, "exchanged_wrenches", lambda _: Stub(0.011, moves=0.1))
    found = said(monkeypatch, Stub(0.019, moves=0.9), {"column 'a'": 0.001})
    assert found is not None
    assert (found.code, "column 'a' is reversed" in found.text) == ("swapped_feet", True)


@pytest.mark.parametrize(("misfit", "told"), [(0.012, False), (0.0175, False), (0.0185, True)])
def test_what_moves_is_measured_by_the_soles(
    monkeypatch: pytest.MonkeyPatch, misfit: float, told: bool
) -> None:
    """Half of it moves: of a robot half as large half as much counts."""
    stance = Stub(misfit, exchanged=misfit / 20, moves=0.9)
    assert (said(monkeypatch, stance) is not None) == told
    small = SimpleNamespace(polygon=[[0.15, 0.05], [-0.15, -0.05]])
    monkeypatch.setattr(Stub, "robot", SimpleNamespace(feet={"left": SimpleNamespace(sole=small)}))
    assert said(monkeypatch, stance) is not None


@pytest.mark.parametrize(("misfit", "told"), [(0.049, False), (0.051, True)])
def test_joints_that_are_exchanged(monkeypatch: pytest.MonkeyPatch, misfit: float, told: bool) -> None:
    found = said(monkeypatch, Stub(misfit), pair="'joint.a.position', 'joint.b.position'")
    assert (found is not None) == told
    text = (
        "'joint.a.position', 'joint.b.position': exchanged, the wrenches balance gravity far better (check the joints' "
        "names, order and unit)"
    )
    assert not found or (found.code, found.text, found.fatal) == ("joint_names", text, True)


@pytest.mark.parametrize(
    ("left", "best", "told"),
    [(0.034, np.inf, True), (0.036, np.inf, False), (0.02, 0.031, True), (0.02, 0.029, False)],
)
def test_a_sensor_that_is_turned_by_a_quarter(
    monkeypatch: pytest.MonkeyPatch, left: float, best: float, told: bool
) -> None:
    """It leaves a third, and clearly less than any reversal."""
    turned = TurnedWrench(left, 1.0, -90, "columns 'wrench.left.*'")
    found = said(monkeypatch, Stub(0.1), {"column 'a'": best} if np.isfinite(best) else {}, turned=turned)
    assert (found is not None and found.code == "wrench_turned") == told
    if found and told:
        text = "columns 'wrench.left.*': turned by -90 deg about the sensors' z axes, the wrenches balance gravity to"
        assert found.text.startswith(f"{text} {100 * left:.1f} cm instead of 10.0 cm")
        assert not found.fatal


@pytest.mark.parametrize(("turn", "told"), [(9.7, False), (10.4, True), (-10.4, True)])
def test_an_imu_that_tilts_another_way(monkeypatch: pytest.MonkeyPatch, turn: float, told: bool) -> None:
    angle = np.linspace(0.0, 2 * np.pi, 10, endpoint=False)
    tilt = np.column_stack([0.05 * np.cos(angle), 0.05 * np.sin(angle), np.full(10, np.sqrt(1 - 0.05**2))])
    found = said(monkeypatch, Stub(tilt=tilt, turn=turn))
    assert (found is not None) == told
    if found:
        assert found.code == "imu_turned"
        assert (
            f"directions that are {turn:.0f} deg apart about the vertical (valid: within 10 deg;"
            in found.text
        )
