"""Careless changes at places that a map of the lines showed with few tests or none, each with its test."""

from __future__ import annotations

from mutant import Mutant

SELDOM_RUN = (
    Mutant(
        "exporters/contact/springs.py",
        "all points at one depth",
        "RADIUS - foot.depth - p.lower]",
        "RADIUS - foot.depth]",
        ("exporters/test_points.py",),
    ),
    Mutant(
        "exporters/contact/bullet.py",
        "a link's own friction is not read",
        'friction = float(vector(given.get("value"), 1, "lateral_friction")[0])',
        "friction = FRICTION",
        ("exporters/test_contact_files.py",),
    ),
    Mutant(
        "exporters/sdf/target.py",
        "the plate stands at the bush",
        "set_pose(collision, pose(centre))",
        "set_pose(collision, pose(0 * centre))",
        ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "exporters/sdf/from_urdf.py",
        "a mesh loses its scale",
        'kind.get("scale"), 3, "scale", 1.0',
        'None, 3, "scale", 1.0',
        ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "exporters/sdf/from_urdf.py",
        "damping for friction",
        'dynamics.get(key, "0")',
        'dynamics.get("damping", "0")',
        ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "exporters/urdf/geometry.py",
        "a mesh is read without its scale",
        "np.asarray(scale, float))",
        "np.ones(3))",
        ("exporters/test_urdf_tree.py",),
    ),
    Mutant(
        "robot/urdf.py",
        "why Pinocchio refuses is not told",
        "broken or (str(error)",
        "broken and (str(error)",
        ("robot/test_urdf.py",),
    ),
    Mutant(
        "feet/prepare_log.py",
        "lifted above a foot that carries nothing",
        " & (other.force_z > carried)",
        "",
        ("feet/test_prepare_log.py",),
    ),
    Mutant(
        "logs/stretches.py",
        "a stretch without its end",
        "np.flatnonzero(~lost[: end + 1])",
        "np.flatnonzero(~lost[: end - 1])",
        ("logs/test_stretches.py",),
    ),
    Mutant(
        "dynamics/base_parameters.py",
        "a sign is told twice",
        "{abs(share):.6g}",
        "{share:.6g}",
        ("dynamics/test_base_parameters.py",),
    ),
    Mutant(
        "logs/readers/mc_rtc.py",
        "any three letters begin a log",
        " and magic[:3] == MAGIC",
        "",
        ("logs/readers/test_edges.py",),
    ),
    Mutant(
        "logs/readers/ports.py",
        "the URDF's order for fewer joints",
        "count == len(robot.joint_names)",
        "count >= len(robot.joint_names)",
        ("logs/readers/test_edges.py",),
    ),
    Mutant(
        "logs/readers/ros/sensor_topics.py",
        "the joints' topic of the robot file is not heeded",
        'joints = [known[wanted["joints"]]]',
        "joints = joints[:1]",
        ("logs/readers/test_bags.py",),
    ),
    Mutant(
        "logs/readers/ros/topics.py",
        "what messages lack moves what others have",
        "            if name not in present:",
        "            if name not in series.values:",
        ("logs/readers/test_layouts.py",),
    ),
    Mutant(
        "logs/readers/ros/bag.py",
        "clocks that never meet are used",
        "if latest_start > first_end:",
        "if latest_start > first_end + 10**12:",
        ("logs/readers/test_bag_clocks.py",),
    ),
    Mutant(
        "cli/fleet/inertia.py",
        "unseen logs are fitted, too",
        ' for log in group.logs if log.role == "fit"',
        " for log in group.logs",
        ("fleet/test_inertia.py",),
    ),
)
