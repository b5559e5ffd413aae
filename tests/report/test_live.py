"""The live view: what a browser shows of the estimates."""

from __future__ import annotations

import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway
from biped_robot import write_robot
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.report import live
from plantar.robot.model import RobotModel, load_robot
from report_visit import launched

pytest.importorskip("viser")


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return load_robot(write_robot(tmp_path_factory.mktemp("live")))


@pytest.fixture(scope="module")
def replay(robot: RobotModel) -> Replay:
    return FootEstimator(robot, wrench_delay=0.0).replay(record(sway(duration=20.0)))


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from launched()


def show(view: live.LiveView, replay: Replay, step: int = 10) -> None:
    for sample in range(0, len(replay.time), step):
        view.show(replay.time[sample], {foot: replay.estimate(foot, sample) for foot in replay.feet})


def test_it_is_served_here_alone_and_says_nothing_on_stdout(
    robot: RobotModel, replay: Replay, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with live.LiveView(robot, port=port) as view:
        assert view.url == f"http://127.0.0.1:{port}"
        assert urllib.request.urlopen(view.url).status == 200
        with pytest.raises(
            urllib.error.URLError
        ):  # another of this machine's addresses, as a network's would be
            urllib.request.urlopen(view.url.replace("127.0.0.1", "127.0.0.2"), timeout=5)
        assert not view.wait_for_reader(0.0)
        show(view, replay)
    assert capsys.readouterr().out == ""


def test_a_log_is_shown_as_fast_as_it_was_recorded(replay: Replay, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever it takes to show a sample, and however long the log's clock had run."""
    now, shown = 50.0, list[tuple[float, float, dict[str, Any]]]()

    def sleep(seconds: float) -> None:
        nonlocal now
        now += seconds

    def show(moment: float, estimates: dict[str, Any]) -> None:
        nonlocal now
        now += 0.01 if len(shown) != 3 else 0.5  # that one takes longer than its turn
        shown.append((now, moment, estimates))

    monkeypatch.setattr(live.time, "monotonic", lambda: now)
    monkeypatch.setattr(live.time, "sleep", sleep)
    live.play(SimpleNamespace(show=show), replay)  # type: ignore[arg-type]
    first = float(replay.time[0])
    assert len(shown) == pytest.approx((replay.time[-1] - first) / live.FRAME, abs=1.5)
    for at, moment, estimates in [*shown[:3], *shown[-20:]]:
        assert at - 50.0 == pytest.approx(moment - first + 0.01, abs=replay.time[1] - first + 1e-6)
        sample = int(np.argmin(np.abs(replay.time - moment)))
        assert estimates == {foot: replay.estimate(foot, sample) for foot in replay.feet}


def test_each_ankle_stands_above_its_sole_where_the_bush_is(robot: RobotModel, replay: Replay) -> None:
    """The test biped's bush is 30 mm over its sole, and turns the other way than the sole that is drawn flat."""
    with live.LiveView(robot, port=8491) as view:
        assert live.from_the_right(robot) == ["right", "left"]  # whatever their order in the robot file
        for foot, side in (("left", 0.15), ("right", -0.15)):
            assert view._feet[foot]._ankle.position == pytest.approx((0.0, side, 0.03))
            assert view._feet[foot]._name.text == foot
            assert view._feet[foot]._name.position[1] == pytest.approx(side)
        estimate = replay.estimate("left", len(replay.time) - 1)
        view.show(9.0, {"left": replay.estimate("left", 0)})
        view.show(0.0, {"left": estimate})  # begun anew, it is shown at once
        ankle = view._feet["left"]._ankle
        pitch, roll = (live.LARGER * one.deflection for one in (estimate.pitch, estimate.roll))
        turn = Rotation.from_quat(ankle.wxyz, scalar_first=True)
        expected = (Rotation.from_euler("y", pitch) * Rotation.from_euler("x", roll)).inv()
        assert (turn.inv() * expected).magnitude() == pytest.approx(0.0, abs=1e-6)
        above = turn.apply([0.0, 0.0, live.HEIGHT / 2])
        assert ankle.position == pytest.approx([0.0 + above[0], 0.15 + above[1], 0.03 + above[2]], abs=1e-6)


def test_a_plots_scale_holds_its_values_and_a_little_more() -> None:
    """A band from 4 to 8 over a second that is long after the log's first; then a line at zero, of another log."""
    made = SimpleNamespace(gui=SimpleNamespace(add_uplot=lambda **given: SimpleNamespace(**given)))
    plot = live._Plot(made, "K", lines=3)  # type: ignore[arg-type]
    for now, values in ((1000.0, (5.0, 4.0, 6.0)), (1002.0, (7.0, 6.0, 8.0))):
        plot.add(now, *values)
    assert plot._plot.scales["x"]["range"] == pytest.approx((1000.0, 1002.0))
    assert plot._plot.scales["y"]["range"] == pytest.approx((3.6, 8.4))
    plot.add(1000.0 + live.LOOKED_BACK + 1.0, 5.0, 4.5, 5.5)
    assert plot._plot.scales["x"]["range"][0] == 1002.0, "what is longer ago is let go"
    plot.add(0.0, 0.0, 0.0, 0.0)
    assert plot._plot.scales["x"]["range"] == pytest.approx((0.0, 1.0))
    assert plot._plot.scales["y"]["range"] == pytest.approx((-1.0, 1.0))


def test_pictures_that_are_closer_than_a_browser_draws_are_left_out(robot: RobotModel) -> None:
    """Time may begin anew, and is drawn at once."""
    with live.LiveView(robot, port=8492) as view:
        drawn: list[float] = []
        view._feet = {"left": SimpleNamespace(show=lambda now, _: drawn.append(now))}  # type: ignore[dict-item]
        for now in (0.0, 0.4 * live.FRAME, 0.9 * live.FRAME, 1.1 * live.FRAME, 1.2 * live.FRAME, 5.0, 0.0):
            view.show(now, {"left": SimpleNamespace()})  # type: ignore[dict-item]
    assert drawn == [0.0, 1.1 * live.FRAME, 5.0, 0.0]


def test_a_browser_draws_it(robot: RobotModel, replay: Replay, browser: Any) -> None:
    with live.LiveView(robot, port=8481) as view:
        page, errors = browser.new_page(), list[str]()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(view.url)
        assert view.wait_for_reader(20.0)
        show(view, replay)
        page.wait_for_function("document.body.innerText.includes('stance, ')", timeout=20_000)
        page.wait_for_function("document.querySelectorAll('.uplot').length == 12", timeout=20_000)
        text = page.inner_text("body")
        page.close()
    assert errors == []
    assert "not to be trusted: nothing" in text
    assert "pitch: K, N·m/rad" in text
