"""Careless changes of geometry, of a contact's push and of what is left out, which hand-solved cases notice."""

from __future__ import annotations

from mutant import Mutant

BY_HAND = (
    Mutant(
        "contact/polygon.py", "no points are sorted as an outline",
        "if len(points) < 3 or not", "if len(points) < 3 and not", ("contact/test_polygon.py",),
    ),
    Mutant(
        "contact/polygon.py", "the gap between the farthest edges' lines",
        ".min(axis=0).max())", ".max(axis=0).max())", ("contact/test_polygon.py",),
    ),
    Mutant(
        "contact/polygon.py", "distances to the edges as long as these are",
        " / np.linalg.norm(edges, axis=1, keepdims=True)", "", ("contact/test_polygon.py",),
    ),
    Mutant(
        "contact/polygon.py", "the edges' lines through the outline as it was given",
        "np.sum(convex_hull(polygon) * normals", "np.sum(polygon * normals", ("contact/test_polygon.py",),
    ),
    Mutant(
        "logs/readers/roles.py", "turns about moving axes",
        "cr * cp * sy - sr * sp * cy", "cr * cp * sy + sr * sp * cy", ("logs/readers/test_roles.py",),
    ),
    Mutant(
        "logs/readers/roles.py", "a quaternion's columns in one order only",
        "for i, axis in enumerate(last)}", 'for i, axis in enumerate("wxyz")}', ("logs/readers/test_roles.py",),
    ),
    Mutant(
        "exporters/contact/alone.py", "a damping ratio of twice its size",
        "0.5 * damping / np.sqrt(stiffness)", "damping / np.sqrt(stiffness)", ("exporters/test_points.py",),
    ),
    Mutant(
        "exporters/contact/alone.py", "the impedance takes nothing off",
        "scale = (1 - impedance) * inverse_mass", "scale = inverse_mass", ("exporters/test_points.py",),
    ),
    Mutant(
        "exporters/contact/alone.py", "the inertia of a bare spring is a damper's",
        "0.5 * INERTIA_TIME**2 * point.stiffness", "0.5 * INERTIA_TIME * point.stiffness",
        ("exporters/test_points.py",),
    ),
    Mutant(
        "feet/assess/odd_recordings.py", "the first walk's own deviation is forgotten",
        "np.diag(std[1:] ** 2) + std[0] ** 2", "np.diag(std[1:] ** 2)", ("feet/assess/test_odd_recordings.py",),
    ),
    Mutant(
        "robot_guess/stance.py", "only the last joint's gaps count",
        "whole &= np.isfinite(values)", "whole = np.isfinite(values)", ("robot_guess/test_stance.py",),
    ),
)  # fmt: skip
