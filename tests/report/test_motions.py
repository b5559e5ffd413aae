"""What each plot of a motion says it shows."""

from __future__ import annotations

import numpy as np

from plantar.report.motions import motion_views
from plantar.results.residuals import Track
from report_walks import walk_result


def test_plots_are_named_by_what_they_show() -> None:
    """A bush is pressed by a force and turned by a torque."""
    time = np.linspace(0.0, 1.0, 11)
    columns = {f"{axis}.{name}": time for axis in ("pitch", "z") for name in ("deflection", "torque")}
    track = Track(
        "walk_1", "fit", "left", time, time >= 0, np.full(11, "single"), columns | {"force_z": time}
    )
    views, _ = motion_views(walk_result(), [track])
    (foot,) = views[0].feet
    assert {(plot.axis, plot.kind): plot.title for plot in foot.plots} == {
        ("pitch", "torque"): "left pitch: measured and reconstructed torque",
        ("pitch", "loop"): "left pitch: torque over angle",
        ("z", "torque"): "left z: measured and reconstructed force",
        ("z", "loop"): "left z: force over displacement",
    }
    assert {(plot.axis, plot.title) for plot in views[0].both} == {
        ("pitch", "Bush pitch angle"), ("z", "Bush z displacement"), ("", "Vertical force"),
    }  # fmt: skip


def test_what_one_foot_shows_is_drawn_of_both() -> None:
    time = np.linspace(0.0, 1.0, 11)
    every = {f"{axis}.{name}": time for axis in ("pitch", "z") for name in ("deflection", "torque")}
    more = {"force_z": time, "cop_x": time, "cop_y": time}
    pitch = {name: values for name, values in every.items() if name.startswith("pitch")}
    tracks = [Track("walk_1", "fit", foot, time, time >= 0, np.full(11, "single"), columns)
              for foot, columns in (("left", every | more), ("right", pitch | {"cop_x": time}))]  # fmt: skip
    both = {plot.title for plot in motion_views(walk_result(), tracks)[0][0].both}
    assert both == {"Bush pitch angle", "Bush z displacement", "Vertical force", "Centre of pressure"}
    bare = {plot.title for plot in motion_views(walk_result(), tracks[1:])[0][0].both}
    assert bare == {"Bush pitch angle"}, "a centre of pressure has two numbers"
