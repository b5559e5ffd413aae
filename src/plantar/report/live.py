"""The feet in a browser while the estimator runs: ankles over their soles, deflections, K and C with their bands."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping
from contextlib import redirect_stdout
from io import StringIO
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import pinocchio as pin

from plantar.contact.polygon import convex_hull
from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.errors import needs
from plantar.online.estimates import AxisEstimate, Contact, Flag, FootEstimate
from plantar.online.replay import Replay
from plantar.robot.model import RobotModel

if TYPE_CHECKING:
    import viser

FRAME = 0.05  # s from picture to picture
LOOKED_BACK = 60.0  # s that the plots hold
LARGER = 10.0  # times: a bush bends by a degree, which nobody would see
CAMERA = (0.5, 0.35, 0.35)  # m, looking at the middle between the soles
HEIGHT = 0.08  # m, of what is drawn of an ankle
COLOURS: Mapping[Contact, tuple[int, int, int]] = {
    Contact.AIR: (170, 178, 186),
    Contact.LANDING: (225, 170, 60),
    Contact.STANCE: (60, 140, 90),
}
LINE, BAND = "#1f6fb2", "rgba(31, 111, 178, 0.2)"


class LiveView:
    """A page at `url` that shows the estimates as they come.

    Args:
        robot: whose soles are drawn.
        port: of the page on this machine; it is served to no other.

    Raises:
        MissingExtra: viser is not installed.

    Example:
        >>> with LiveView(robot) as view:
        ...     found = estimator.step(time, position, wrench, attitude=attitude)
        ...     view.show(time, found)
    """

    def __init__(self, robot: RobotModel, port: int = 8080) -> None:
        with needs("viser", "figures", "the live view"):
            import viser
        with redirect_stdout(StringIO()):  # it announces itself there, where tables go
            self.server = viser.ViserServer("127.0.0.1", port, label="plantar online", verbose=False)
        self.server.initial_camera.position = CAMERA
        self.url = f"http://127.0.0.1:{self.server.get_port()}"
        order = from_the_right(robot)
        self._feet = {name: _FootView(self.server, robot, name, order.index(name)) for name in robot.feet}
        self._next = -np.inf

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with redirect_stdout(StringIO()):
            self.server.stop()

    def wait_for_reader(self, longest: float) -> bool:
        """Until a browser has opened the page, for at most `longest` [s]; whether one has."""
        until = time.monotonic() + longest
        while not self.server.get_clients() and time.monotonic() < until:
            time.sleep(FRAME)
        return bool(self.server.get_clients())

    def show(self, now: float, found: Mapping[str, FootEstimate]) -> None:
        """What holds at `now` [s]; calls that are closer than a picture to the last one do nothing."""
        if self._next - FRAME <= now < self._next:
            return
        self._next = now + FRAME
        with self.server.atomic():
            for name, estimate in found.items():
                self._feet[name].show(now, estimate)


def from_the_right(robot: RobotModel) -> list[str]:
    """The feet in the order in which they stand, all joints at zero."""
    rotations, places = robot.tree.poses(np.zeros((1, len(robot.joint_names))))

    def aside(name: str) -> float:
        joint, sole = robot.frame(robot.feet[name].sole.placement)
        return float(places[joint, 0, 1] + rotations[joint, 0, 1] @ sole.translation)

    return sorted(robot.feet, key=aside)


class _FootView:
    """One foot's shapes in the scene and its plots beside it."""

    def __init__(self, server: viser.ViserServer, robot: RobotModel, name: str, place: int) -> None:
        """place: of the foot, counted from the right."""
        foot = robot.feet[name]
        outline = convex_hull(foot.sole.polygon)
        aside = np.array([0.0, 0.3 * (place - (len(robot.feet) - 1) / 2), 0.0])
        to_bush = (robot.frame(foot.sole.placement)[1].inverse() * robot.frame(foot.bush)[1]).translation
        self._middle = aside + to_bush
        flat = np.column_stack([outline, np.zeros(len(outline))])
        fan = np.array([[0, corner, corner + 1] for corner in range(1, len(flat) - 1)])
        scene = server.scene
        self._sole = scene.add_mesh_simple(
            f"{name}/sole", flat + aside, fan, color=(120, 120, 120), side="double"
        )
        size = (*(0.6 * np.ptp(outline, axis=0)), HEIGHT)
        self._ankle = scene.add_box(
            f"{name}/ankle", dimensions=size, position=tuple(self._middle), opacity=0.7
        )
        self._pressure = scene.add_icosphere(f"{name}/pressure", radius=0.008, color=(200, 50, 50))
        self._aside = aside
        ahead = (outline[:, 0].max(), aside[1], 0.0)
        self._name = scene.add_label(f"{name}/name", name, position=ahead)
        with server.gui.add_folder(name):
            self._text = server.gui.add_markdown("")
            self._plots = [_AxisPlots(server, axis) for axis in ROTATIONAL_AXES]

    def show(self, now: float, found: FootEstimate) -> None:
        pitch, roll = (LARGER * one.deflection for one in (found.pitch, found.roll))
        # The sole is drawn flat, so that the ankle turns the other way.
        ankle = (pin.utils.rotate("y", pitch) @ pin.utils.rotate("x", roll)).T
        x, y, z, w = pin.Quaternion(ankle).coeffs()
        self._ankle.wxyz = (w, x, y, z)
        self._ankle.position = tuple(self._middle + ankle @ np.array([0.0, 0.0, HEIGHT / 2]))
        self._ankle.color = COLOURS[found.contact]
        self._pressure.position = tuple(self._aside + np.array([*found.centre_of_pressure, 0.0]))
        self._pressure.visible = found.contact is not Contact.AIR
        names = (flag.name.lower() for flag in Flag if flag in found.flags and flag.name)
        flags = ", ".join(names) or "nothing"
        self._text.content = (
            f"{found.contact.name.lower()}, {found.load:.0f} N, deflections drawn {LARGER:.0f} times as large  \n"
            f"not to be trusted: {flags}"
        )
        for plots, one in zip(self._plots, (found.pitch, found.roll), strict=True):
            plots.show(now, one)


class _AxisPlots:
    """Deflection, stiffness and damping of one axis over the last minute."""

    def __init__(self, server: viser.ViserServer, axis: Axis) -> None:
        self._deflection = _Plot(server, f"{axis}: deflection, mrad", lines=1)
        self._stiffness = _Plot(server, f"{axis}: K, N·m/rad", lines=3)
        self._damping = _Plot(server, f"{axis}: C, N·m·s/rad", lines=3)

    def show(self, now: float, found: AxisEstimate) -> None:
        self._deflection.add(now, 1e3 * found.deflection)
        if found.stiffness.half_width > abs(found.stiffness.value):
            return  # nothing is known yet
        for plot, one in ((self._stiffness, found.stiffness), (self._damping, found.damping)):
            plot.add(now, one.value, one.value - one.half_width, one.value + one.half_width)


class _Plot:
    """A line over time, or a line with its band."""

    def __init__(self, server: viser.ViserServer, title: str, lines: int) -> None:
        from viser import uplot

        value = uplot.Series(label="value", stroke=LINE, width=1.5)
        edges = tuple(uplot.Series(label=label, stroke=BAND, width=1) for label in ("low", "high"))
        self._rows: deque[tuple[float, ...]] = deque()
        self._plot = server.gui.add_uplot(
            data=(np.zeros(2),) * (1 + lines),
            series=(uplot.Series(label="s"), value, *edges)[: 1 + lines],
            bands=(uplot.Band(series=(3, 2), fill=BAND),) if lines == 3 else None,
            scales=_scales((0.0, 1.0), (0.0, 1.0)),
            axes=(uplot.Axis(), uplot.Axis(space=20)),  # pixels: the usual 30 leave one number
            title=title,
            aspect=2.0,
        )

    def add(self, now: float, *values: float) -> None:
        if self._rows and now <= self._rows[-1][0]:
            self._rows.clear()  # another log
        self._rows.append((now, *values))
        while self._rows[0][0] < now - LOOKED_BACK:
            self._rows.popleft()
        columns = np.array(self._rows).T
        low, high = float(columns[1:].min()), float(columns[1:].max())
        room = 0.1 * (high - low) or 0.1 * abs(high) or 1.0
        self._plot.scales = _scales((columns[0, 0], max(now, columns[0, 0] + 1.0)), (low - room, high + room))
        self._plot.data = tuple(columns)


def _scales(x: tuple[float, float], y: tuple[float, float]) -> dict[str, Any]:
    from viser import uplot

    return {"x": uplot.Scale(time=False, range=x), "y": uplot.Scale(range=y)}


def play(view: LiveView, replay: Replay) -> None:
    """Show a replayed log at the pace at which it was recorded."""
    begun, first = time.monotonic(), float(replay.time[0])
    for moment in np.arange(first, float(replay.time[-1]), FRAME):
        time.sleep(max(0.0, begun + moment - first - time.monotonic()))
        sample = int(np.searchsorted(replay.time, moment))
        view.show(float(replay.time[sample]), {foot: replay.estimate(foot, sample) for foot in replay.feet})
