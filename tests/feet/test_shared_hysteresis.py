"""A memory that other axes of a robot show is taken where one axis shows it less clearly, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.stances import Stances
from plantar.conventions import Axis
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.hidden_memory import NOT_EXCLUDED, TOO_SMALL, moved_by_memory, slope_share
from plantar.feet.fit.worth import in_place_of
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.settings import FeetSettings
from plantar.feet.shared_hysteresis import with_shared_hysteresis
from plantar.models import BoucWen, BushModel, Hardening, KelvinVoigt

RUBBER = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)
STEPPING = Stances(np.arange(4000) // 1000, np.ones(4000))
NEARER = "elastoplastic predicts held-out motion better"


@pytest.fixture(scope="module")
def recordings() -> list[Recording]:
    angle = swayed(4000, seed=1)
    return [made_recording("sway", angle, RUBBER.torque(angle, np.gradient(angle, PERIOD)))]


@pytest.fixture(scope="module")
def clear(recordings: list[Recording]) -> AxisFit:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings())
    assert fit is not None
    assert fit.model.name == "elastoplastic"
    return fit


@pytest.fixture(scope="module")
def spring(recordings: list[Recording], clear: AxisFit) -> AxisFit:
    """As of short stances: the memory is nearer, and gains too little."""
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(), KelvinVoigt())
    assert fit is not None
    assert clear.choice is not None
    return replace(fit, choice=replace(clear.choice, caution=NEARER))


def foot(fit: AxisFit, recordings: list[Recording], *, steps: bool = False) -> FittedFoot:
    if steps:
        recordings = [replace(recording, stances={FOOT: STEPPING}) for recording in recordings]
    ready: Any = SimpleNamespace(fitted=recordings, settings=FeetSettings())
    return FittedFoot(FOOT, None, {"pitch": fit}, {}, ready, ready, (), elsewhere=None)  # type: ignore[arg-type]


def test_a_memory_that_another_axis_shows_is_taken(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit
) -> None:
    feet = {"one": foot(spring, recordings), "other": foot(clear, recordings)}
    found = with_shared_hysteresis(feet)["one"].fits["pitch"]
    assert found.model.name == "elastoplastic"
    assert found.values[0] == pytest.approx(RUBBER.stiffness, rel=0.02)
    assert spring.values[0] > 1.1 * RUBBER.stiffness
    assert found.choice is not None
    assert found.choice.caution is None
    assert [score.model.name for score in found.choice.ranking if score.chosen] == ["elastoplastic"]
    assert "other axes" in found.reason


def changed(found: AxisFit, **scores: object) -> AxisFit:
    """With no caution, and something else said of each model but spring and damper."""
    assert found.choice is not None
    ranking = tuple(
        replace(
            score,
            chosen=score.model.name == "kelvin_voigt",
            **({} if score.model.name == "kelvin_voigt" else scores),
        )
        for score in found.choice.ranking
    )
    return replace(found, choice=replace(found.choice, caution=None, ranking=ranking))


def of(one: AxisFit, other: AxisFit, recordings: list[Recording], *, steps: bool = False) -> AxisFit:
    feet = {"one": foot(one, recordings, steps=steps), "other": foot(other, recordings)}
    return with_shared_hysteresis(feet)["one"].fits["pitch"]


def test_no_memory_is_made_up(recordings: list[Recording], clear: AxisFit, spring: AxisFit) -> None:
    worse = changed(spring, held_out_rms=9e9, refused=None)
    for one, other in ((spring, spring), (worse, clear)):
        assert of(one, other, recordings) is one


def test_of_a_foot_that_steps_a_memory_is_taken_as_soon_as_it_predicts_better(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("plantar.feet.shared_hysteresis.fit_axis", lambda *_: clear)
    better = changed(spring, refused=None)
    assert of(better, clear, recordings).model.name == "kelvin_voigt"
    assert of(better, clear, recordings, steps=True).model.name == "elastoplastic"
    assert of(better, spring, recordings, steps=True) is better


@pytest.mark.parametrize(("share", "taken"), [(0.2, True), (0.3, False)])
def test_a_memory_beside_a_spring_that_is_not_known_is_not_taken(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit, share: float, taken: bool
) -> None:
    """One in which a spring is known to half of it at best: 1.96 deviations of 0.26."""
    covariance = clear.covariance.copy()
    covariance[0, 0] = (share * clear.values[0]) ** 2
    found = of(spring, replace(clear, covariance=covariance), recordings)
    assert (found.model.name == "elastoplastic") is taken


@pytest.mark.parametrize(
    ("scores", "steps"),
    [
        ({"refused": "is hardly reached"}, False),
        ({"refused": None}, False),  # it was told from zero and predicts better, too little to be chosen
        ({"refused": "is hardly reached"}, True),
        ({"held_out_rms": 9e9, "refused": None}, True),
    ],
)
def test_a_memory_that_is_neither_shown_nor_excluded_makes_a_caution(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit, scores: dict[str, object], steps: bool
) -> None:
    unsure = changed(spring, **scores)
    found = of(unsure, clear, recordings, steps=steps)
    assert found.model.name == "kelvin_voigt"
    assert found.choice is not None
    assert "neither show nor exclude" in (found.choice.caution or "")
    alone = of(unsure, unsure, recordings, steps=steps)
    assert alone is unsure


def test_motions_too_small_to_make_the_others_slip_exclude_nothing(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit
) -> None:
    """A memory that predicts no better excludes one, unless the axis bends by less than others need to slip."""
    assert clear.choice is not None
    slips = float(clear.choice.fit.shape[0])
    assert slips == pytest.approx(RUBBER.slip_angle, rel=0.1)
    excluded = changed(spring, held_out_rms=9e9, refused=None)
    assert excluded.choice is not None
    assert of(excluded, clear, recordings) is excluded
    small = replace(excluded, choice=replace(excluded.choice, reach=slips))
    found = of(small, clear, recordings)
    assert found.choice is not None
    assert found.choice.caution is not None
    assert "neither show nor exclude" in found.choice.caution
    assert of(small, spring, recordings) is small  # nobody shows one
    doubted = replace(spring, choice=replace(spring.choice, reach=slips)) if spring.choice else spring
    assert of(doubted, clear, recordings).model.name == "kelvin_voigt"  # nor is one taken from there
    harder = of(replace(small, model=Hardening()), clear, recordings)  # nor does it of a spring that hardens
    assert harder.choice is not None
    assert harder.choice.caution is not None


@pytest.mark.parametrize(("reach", "unsure"), [(1.9, True), (2.1, False)])
def test_a_memory_found_where_springs_do_as_well_may_still_be_taken_for_one(
    recordings: list[Recording], clear: AxisFit, reach: float, unsure: bool
) -> None:
    """A spring that is put in its place later is as unsure as the elements of other axes are stiff; steps apart."""
    assert clear.choice is not None
    slips = float(clear.choice.fit.shape[0])
    own = replace(clear, choice=replace(clear.choice, reach=reach * slips))
    found = of(own, clear, recordings)
    assert found.model.name == "elastoplastic"
    assert found.hidden_share == pytest.approx(slope_share(clear) if unsure else 0.0)
    assert of(own, clear, recordings, steps=True).hidden_share == 0.0
    spring = fit_axis(recordings, FOOT, "pitch", FeetSettings(), KelvinVoigt())
    assert spring is not None
    needless = in_place_of(found, spring)
    assert needless.choice is not None
    assert needless.hidden_share == found.hidden_share
    assert needless.choice.caution == (NOT_EXCLUDED if unsure else clear.choice.caution)
    moved = moved_by_memory(needless, steps=False)
    assert moved[0] >= found.hidden_share * needless.values[0]


def test_a_spring_that_hardens_elsewhere_is_no_memory(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit
) -> None:
    hardens = replace(clear, model=Hardening())
    unsure = changed(spring, refused="is hardly reached")
    assert of(unsure, hardens, recordings) is unsure


@pytest.mark.parametrize(
    ("axis", "elsewhere", "caution", "model", "dropped"),
    [
        ("roll", 0.0151, None, KelvinVoigt(), True),
        ("roll", 0.0151, "drift", KelvinVoigt(), False),  # there it is open as well
        (
            "roll",
            0.0074,
            None,
            KelvinVoigt(),
            False,
        ),  # half of the small motions' limit: roll's border is half as far
        ("roll", 0.0151, None, BoucWen(), False),
        (
            "pitch",
            0.0151,
            None,
            KelvinVoigt(),
            False,
        ),  # at pitch's border roll would have to bend twice as far
        ("pitch", 0.0301, None, KelvinVoigt(), True),
    ],
)
def test_where_the_other_axis_bends_the_rubber_and_shows_no_memory_small_motions_hide_none(
    spring: AxisFit, axis: Axis, elsewhere: float, caution: str | None, model: BushModel, dropped: bool
) -> None:
    assert spring.choice is not None
    small = replace(
        spring, axis=axis, choice=replace(spring.choice, reach=0.012, caution=TOO_SMALL.format(0.012))
    )
    other: Axis = "pitch" if axis == "roll" else "roll"
    wide = replace(
        spring,
        axis=other,
        model=model,
        shape=np.ones(len(model.shape_terms)),
        values=np.ones(len(model.terms)),
        choice=replace(spring.choice, reach=elsewhere, caution=caution),
    )
    corners = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    robot = SimpleNamespace(feet={FOOT: SimpleNamespace(sole=SimpleNamespace(polygon=corners))})
    ready: Any = SimpleNamespace(fitted=[], settings=FeetSettings(), robot=robot)
    one = FittedFoot(FOOT, None, {axis: small, other: wide}, {}, ready, ready, (), elsewhere=None)  # type: ignore[arg-type]
    found = with_shared_hysteresis({"one": one})["one"].fits[axis]
    assert found.choice is not None
    assert (found.choice.caution is None) == dropped


@pytest.mark.parametrize(
    ("gains", "scores", "steps", "hinted"),
    [
        ((0.05, 0.15, 0.17), {}, True, True),
        ((0.05, 0.15, 0.17), {}, False, False),  # feet that stand show a memory by themselves
        ((0.15, 0.17), {}, True, False),  # two may do so by chance
        ((0.05, 0.06, 0.08), {}, True, False),
        ((-0.01, 0.2, 0.2), {}, True, False),  # one axis has none
        ((0.05, 0.15, 0.17), {"refused": "is hardly reached"}, True, False),
    ],
)
def test_a_memory_that_every_axis_of_a_walk_hints_at_makes_a_caution(
    recordings: list[Recording],
    spring: AxisFit,
    gains: tuple[float, ...],
    scores: dict[str, object],
    steps: bool,
    hinted: bool,
) -> None:
    assert spring.choice is not None
    plain = next(score for score in spring.choice.ranking if score.model.name == "kelvin_voigt")
    fits = [
        changed(spring, **{"refused": None, "held_out_rms": (1 - gain) * plain.held_out_rms, **scores})
        for gain in gains
    ]
    feet = {str(place): foot(fit, recordings, steps=steps) for place, fit in enumerate(fits)}
    for one in with_shared_hysteresis(feet).values():
        choice = one.fits["pitch"].choice
        assert choice is not None
        assert (choice.caution or "").startswith("hysteresis predicts held-out steps better") is hinted
        assert not hinted or "by 12 % together" in str(choice.caution)


def test_axes_that_miss_more_weigh_more_in_a_hint(recordings: list[Recording], spring: AxisFit) -> None:
    """3 of 30, 0.3 of 1 and of 1: together what the first gains, 10 %, and a little."""
    assert spring.choice is not None

    def missing(plain: float, memory: float) -> AxisFit:
        fit = changed(spring, refused=None, held_out_rms=memory)
        assert fit.choice is not None
        ranking = tuple(
            replace(score, held_out_rms=plain) if score.model.name == "kelvin_voigt" else score
            for score in fit.choice.ranking
        )
        return replace(fit, choice=replace(fit.choice, ranking=ranking))

    def caution(first: float) -> str | None:
        fits = [missing(30.0, first), missing(1.0, 0.7), missing(1.0, 0.7)]
        feet = {str(place): foot(fit, recordings, steps=True) for place, fit in enumerate(fits)}
        choice = with_shared_hysteresis(feet)["1"].fits["pitch"].choice
        assert choice is not None
        return choice.caution

    assert caution(29.0) is None
    assert "by 10 % together" in str(caution(26.9))


@pytest.mark.parametrize(("softer", "hinted"), [(0.04, False), (0.06, True)])
def test_a_memory_that_leaves_stiffness_as_it_is_is_no_hint(
    recordings: list[Recording], spring: AxisFit, softer: float, hinted: bool
) -> None:
    assert spring.choice is not None
    plain = next(score for score in spring.choice.ranking if score.model.name == "kelvin_voigt")
    memory = next(score for score in spring.choice.ranking if score.model.name == "elastoplastic")
    values = memory.fit.values.copy()
    values[0] = (1 - softer) * plain.fit.values[0]
    fit = changed(
        spring, refused=None, held_out_rms=0.8 * plain.held_out_rms, fit=replace(memory.fit, values=values)
    )
    feet = {name: foot(fit, recordings, steps=True) for name in ("one", "two", "three")}
    choice = with_shared_hysteresis(feet)["one"].fits["pitch"].choice
    assert choice is not None
    assert (choice.caution is not None) is hinted


def test_an_axis_that_a_spring_explains_denies_a_hint(recordings: list[Recording], spring: AxisFit) -> None:
    assert spring.choice is not None
    rms = 0.8 * max(score.held_out_rms for score in spring.choice.ranking)
    hints = changed(spring, refused=None, held_out_rms=rms)
    fits = dict.fromkeys(("one", "two", "three"), hints)
    feet = {name: foot(fit, recordings, steps=True) for name, fit in fits.items()}
    denied = feet | {"four": foot(replace(spring, choice=None), recordings, steps=True)}
    for given, hinted in ((feet, True), (denied, False)):
        choice = with_shared_hysteresis(given)["one"].fits["pitch"].choice
        assert choice is not None
        assert (choice.caution is not None) is hinted


@pytest.mark.parametrize(("wander", "taken"), [(0.0, True), (2e-4, False)])
def test_an_axis_about_which_a_foot_hardly_turns_shows_no_memory_to_others(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit, wander: float, taken: bool
) -> None:
    """Its angle is mostly an attitude that wanders, which no torque follows: that is no hysteresis of the rubber."""
    angle = 0.01 * swayed(4000, seed=1)
    read = angle + (swayed(4000, amplitude=wander, seed=9) if wander else 0.0)
    faint = [made_recording("sway", read, RUBBER.torque(angle, np.gradient(angle, PERIOD)))]
    feet = {"one": foot(spring, recordings), "other": foot(clear, faint)}
    found = with_shared_hysteresis(feet)["one"].fits["pitch"]
    assert (found.model.name == "elastoplastic") == taken


@pytest.mark.parametrize(("told", "creeps"), [(NEARER, True), (NEARER, False), (None, True)])
def test_where_one_axis_creeps_no_spring_that_a_memory_beats_is_without_a_caution(
    told: str | None, creeps: bool, recordings: list[Recording], spring: AxisFit
) -> None:
    """Other axes are of the same rubber. A spring that no memory beats keeps what it has."""
    assert spring.choice is not None
    creeping = replace(spring, choice=replace(spring.choice, caution=told, creeps=creeps))
    beaten = replace(spring, axis="roll", choice=replace(spring.choice, caution=None))
    alone = tuple(score for score in spring.choice.ranking if score.model.name == "kelvin_voigt")
    best = replace(spring, choice=replace(spring.choice, caution=None, ranking=alone))
    feet = {
        "left": replace(foot(creeping, recordings), fits={"pitch": creeping, "roll": beaten}),
        "right": foot(best, recordings),
    }
    found = with_shared_hysteresis(feet)
    cautions = [fit.choice and fit.choice.caution for one in found.values() for fit in one.fits.values()]
    assert cautions == [told, NOT_EXCLUDED if told and creeps else None, None]
