"""The faults of the matrix: those of logs and of robot files, pairs of them, and changes that are no fault."""

from __future__ import annotations

import numpy as np

from fault_attitudes import reoriented, turned_heading
from fault_case import Case, Fault, encoders
from fault_changes import one_after_another, removed, rows, thinned, timed
from fault_logs import OF_LOGS
from fault_robots import OF_ROBOTS

ALONE = (*OF_LOGS, *OF_ROBOTS)
PAIRED = (
    ("joints in degrees", "joint names with a prefix"),
    ("IMU 30 ms late", "torques +10 %"),
    ("IMU 15 ms late", "bushes +2 cm in z"),
    ("torques clipped at 50 %", "wrenches 40 ms late"),
    ("bushes +2 cm in z", "torques +10 %"),
    ("wrenches -10 %", "masses -20 %"),
    ("left ankle pitch stuck", "wrenches tared under load"),
    ("wrenches exchanged", "both wrenches reversed"),
    ("left wrench held from the middle on", "left wrench 30 ms late"),
    ("IMU turned by 90 deg about z", "IMU 30 ms late"),
    ("log at 25 Hz", "wrenches 20 ms late"),
    ("wrenches +3 cm in x", "left knee zero off by 3 deg"),
)


def _pair(first: str, second: str) -> Fault:
    by_name = {fault.name: fault for fault in ALONE}
    both = [by_name[name] for name in (first, second)]
    change = one_after_another(*(fault.change for fault in both))
    return Fault(f"{first}; {second}", "pairs", change, (*both[0].words, *both[1].words))


def reversed_columns(case: Case) -> Case:
    return case.with_tables(lambda table: dict(reversed(table.items())))


def with_strangers(case: Case) -> Case:
    """Joints and sensors that the robot file does not know, as of hands and a second IMU."""

    def each(table: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        time = table["time"]
        return {**table, "joint.finger.position": np.sin(time), "imu.head.angular_velocity.x": np.cos(time)}

    return case.with_tables(each)


HEALTHY = (
    Fault("as recorded", "healthy", lambda case: case),
    Fault("clock since 1970", "healthy", timed(lambda time: time + 1.7e9)),
    Fault("columns in another order", "healthy", reversed_columns),
    Fault("joints and sensors beside", "healthy", with_strangers),
    Fault("another heading", "healthy", turned_heading(120.0)),
    Fault("quaternions of the other sign", "healthy", reoriented(lambda q: -q)),
    Fault("no joint velocities", "healthy", removed(encoders("velocity"))),
    Fault("no joint efforts", "healthy", removed(encoders("effort"))),
    Fault("every second row", "healthy", thinned(100.0)),
    Fault("first 2 s cut off", "healthy", rows(lambda time: time > time[0] + 2)),
    Fault(
        "orientation in single precision", "healthy", reoriented(lambda q: q.astype(np.float32).astype(float))
    ),
    Fault("orientation with four digits", "healthy", reoriented(lambda q: np.round(q, 4))),
)

FAULTS = (*HEALTHY, *ALONE, *(_pair(*names) for names in PAIRED))
