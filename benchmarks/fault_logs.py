"""Faults of logs: what sensors, drivers, loggers and people do to columns."""

from __future__ import annotations

from itertools import product

import numpy as np

from fault_attitudes import gyroscope_in_world, loose, on_soft_mount, pulled_to_accelerometer, reoriented
from fault_case import Columns, Fault, encoder, encoders, imu, wrench
from fault_changes import (
    altered,
    bent,
    clipped,
    dead_below,
    drifting_clock,
    dropouts,
    every_nth_held,
    exchanged,
    from_the_middle_on,
    in_one_log,
    in_steps,
    late,
    late_at_times,
    lost_frames,
    low_passed,
    one_after_another,
    overwritten,
    removed,
    renamed,
    rows,
    scaled,
    shifted,
    shuffled,
    stepped,
    tared,
    thinned,
    timed,
    with_hysteresis,
    with_play,
)
from plantar.conventions import GRAVITY

DEGREES = 180 / np.pi
GYROSCOPE, ACCELEROMETER = imu("angular_velocity.*"), imu("linear_acceleration.*")
ORIENTATION = imu("orientation.*")
FORCES, TORQUES = wrench(quantity="force.*"), wrench(quantity="torque.*")
HIP_ROLL, KNEE, ANKLE_PITCH, ANKLE_ROLL = -5, -3, -2, -1  # places in a leg, counted from the foot

UNIT = ("degrees", "looks? like", "N·mm", "unit")
SIGN = ("sign", "reversed", "turns against", "pulls the standing foot")
DELAY = ("delay", r"\blater?\b", "earlier", "behind")
STUCK = ("stuck", "dead", "stands? still", "held", "saturat", "full scale", "frozen")
QUATERNION = ("quaternion", "w x y z", "body to world", "up differs")
GAIN = ("gain", "weight", r"carry .* kg", "scale", "balance")
TARE = ("tare", "zeroed", "contact: always", "weight", "zero", "balance")


UNITS = (
    Fault("joints in degrees", "units", scaled(encoders(), DEGREES), UNIT),
    Fault("left knee in degrees", "units", scaled(encoder("left", place=KNEE), DEGREES), (*UNIT, "limit")),
    Fault("gyroscope in deg/s", "units", scaled(GYROSCOPE, DEGREES), (*UNIT, "gyroscope_scale")),
    Fault("accelerometer in g", "units", scaled(ACCELEROMETER, 1 / GRAVITY), UNIT),
    Fault("accelerometer in mg", "units", scaled(ACCELEROMETER, 1000 / GRAVITY), UNIT),
    Fault("torques in N·mm", "units", scaled(TORQUES, 1000), UNIT),
    Fault("left torques in N·mm", "units", scaled(wrench("left", quantity="torque.*"), 1000), UNIT),
    Fault("torques in N·cm", "units", scaled(TORQUES, 100), UNIT),
    Fault("torques in kgf.m", "units", scaled(TORQUES, 1 / GRAVITY), (*UNIT, "calibration")),
    Fault(
        "wrenches in lbf and lbf.in",
        "units",
        one_after_another(scaled(FORCES, 0.2248), scaled(TORQUES, 8.851)),
        (*UNIT, "carr"),
    ),
    Fault("forces in kgf", "units", scaled(FORCES, 1 / GRAVITY), (*UNIT, "kgf")),
    Fault("wrenches in kgf", "units", scaled(wrench(), 1 / GRAVITY), (*UNIT, "kgf")),
    Fault("wrenches in kN", "units", scaled(wrench(), 1e-3), (*UNIT, "no load", "carr")),
    Fault("time in ms", "units", timed(lambda time: 1e3 * time), ("time",)),
    Fault("time in µs", "units", timed(lambda time: 1e6 * time), ("time",)),
    Fault("time in ns", "units", timed(lambda time: 1e9 * time), ("time",)),
)

SIGNS = (
    Fault("both wrenches reversed", "signs", scaled(wrench(), -1), SIGN),
    Fault("left wrench reversed", "signs", scaled(wrench("left"), -1), SIGN),
    Fault("torques reversed", "signs", scaled(TORQUES, -1), SIGN),
    Fault("left torque y reversed", "signs", scaled(wrench("left", quantity=r"torque\.y"), -1), SIGN),
    Fault("torques x reversed", "signs", scaled(wrench(quantity=r"torque\.x"), -1), SIGN),
    Fault("forces x and y reversed", "signs", scaled(wrench(quantity=r"force\.[xy]"), -1), (*SIGN, "leans")),
    Fault("left knee reversed", "signs", scaled(encoder("left", place=KNEE), -1), SIGN),
    Fault("left ankle pitch reversed", "signs", scaled(encoder("left", place=ANKLE_PITCH), -1), SIGN),
    Fault("ankle rolls reversed", "signs", scaled(encoder(place=ANKLE_ROLL), -1), SIGN),
    Fault("gyroscope reversed", "signs", scaled(GYROSCOPE, -1), (*SIGN, "gyroscope")),
    Fault("gyroscope y reversed", "signs", scaled(imu(r"angular_velocity\.y"), -1), (*SIGN, "gyroscope")),
    Fault(
        "accelerometer reversed", "signs", scaled(ACCELEROMETER, -1), ("linear_acceleration.*(sign|revers)",)
    ),
)

FRAMES = (
    Fault("quaternion as x y z w", "frames", reoriented(lambda q: q[:, [1, 2, 3, 0]]), QUATERNION),
    Fault("quaternion world to body", "frames", reoriented(lambda q: q * [1, -1, -1, -1]), QUATERNION),
    Fault("attitude in NED", "frames", reoriented(lambda q: np.column_stack([-q[:, 1], q[:, 0], -q[:, 3], q[:, 2]])),
          QUATERNION),
    Fault("gyroscope in the world", "frames", gyroscope_in_world, ("gyroscope", "frame")),
    Fault("attitude pulled to the accelerometer by 2/s", "frames", pulled_to_accelerometer(2.0),
          ("accelerometer", "orientation", "attitude")),
    Fault("wrench axes x and y exchanged", "frames",
          exchanged(wrench(quantity=r"(force|torque)\.x"), wrench(quantity=r"(force|torque)\.y")),
          ("sign", "balance", "wrench", "leans", "turned")),
    Fault("left wrench axes x and y exchanged", "frames",
          exchanged(wrench("left", quantity=r"(force|torque)\.x"), wrench("left", quantity=r"(force|torque)\.y")),
          ("sign", "balance", "wrench", "leans", "turned")),
)  # fmt: skip

NAMES = (
    Fault("joint names with a prefix", "names",
          renamed(encoders(".*"), lambda name: name.replace("joint.", "joint.robot/", 1)), ("joint_names",)),
    Fault("joint names with a suffix", "names",
          renamed(encoders(".*"), lambda name: name.replace(".position", "_act.position")), ("joint_names",)),
    Fault("joint names in other case", "names",
          renamed(encoders(".*"), lambda name: ".".join(["joint", name.split(".")[1].swapcase(), name.split(".")[2]])),
          ("joint_names",)),
    Fault("joints in another order", "names", shuffled(encoders("position")), ("joint", "balance", "order")),
    Fault("legs exchanged", "names",
          one_after_another(*(exchanged(encoder("left", place=k), encoder("right", place=k)) for k in range(-6, 0))),
          ("swapped", "sign", "balance", "leg", "joint")),
    Fault("left ankle pitch and roll exchanged", "names",
          exchanged(encoder("left", place=ANKLE_PITCH), encoder("left", place=ANKLE_ROLL)),
          ("joint",)),
    Fault("wrenches exchanged", "names", exchanged(wrench("left"), wrench("right")), ("swapped",)),
    Fault("left leg missing", "names", one_after_another(*(removed(encoder("left", place=k)) for k in range(-6, 0))),
          ("joint",)),
    Fault("left knee missing", "names", removed(encoder("left", place=KNEE)), ("not recorded", "missing")),
    Fault("left ankle pitch missing", "names", removed(encoder("left", place=ANKLE_PITCH)),
          ("not recorded", "missing")),
    Fault("wrench under another name", "names",
          renamed(wrench("left"), lambda name: name.replace(".left", ".sinistra")),
          ("missing",)),
    Fault("IMU under another name", "names",
          renamed(imu(), lambda name: "imu.other." + name.split(".", 2)[2]), ("missing",)),
    Fault("no accelerometer", "names", removed(ACCELEROMETER), ("delay", "accelerometer")),
    Fault("no gyroscope", "names", removed(GYROSCOPE), ("gyroscope",)),
)  # fmt: skip


def _delays(what: str, *columns: Columns, ms: tuple[int, ...]) -> tuple[Fault, ...]:
    return tuple(
        Fault(f"{what} {late_by} ms late", "timing", late(*((each, 1e-3 * late_by) for each in columns)), DELAY)
        for late_by in ms
    )  # fmt: skip


TIMING = (
    *_delays("IMU", imu(), ms=(5, 15, 30, 40, 80, 200)),
    *_delays("gyroscope", GYROSCOPE, ms=(20, 40)),
    *_delays("orientation", ORIENTATION, ms=(30,)),
    *_delays("encoders", encoders(), ms=(10, 30, 100)),
    *_delays("ankles' encoders", encoder(place=ANKLE_PITCH), encoder(place=ANKLE_ROLL), ms=(5,)),
    *_delays("left wrench", wrench("left"), ms=(10, 30, 100)),
    *_delays("right wrench", wrench("right"), ms=(30,)),
    *_delays("wrenches", wrench(), ms=(5, 20, 40, 80, 150)),
    Fault("left wrench 20, right 60 ms late", "timing", late((wrench("left"), 0.02), (wrench("right"), 0.06)), DELAY),
    Fault("IMU 20, wrenches 50 ms late", "timing", late((imu(), 0.02), (wrench(), 0.05)), DELAY),
    Fault("IMU 40, encoders 20 ms late", "timing", late((imu(), 0.04), (encoders(), 0.02)), DELAY),
    # Of the campaign: an operator holds the robot in it, so that no delay shows.
    *(Fault(f"{what} {ms} ms late in the second log alone", "timing",
            in_one_log(late((columns, 1e-3 * ms))), DELAY)
      for what, columns, ms in (("IMU", imu(), 8), ("IMU", imu(), 30), ("wrenches", wrench(), 13))),
    *(Fault(f"{what} 20 ms late alone", "timing", late((columns, 0.02)), DELAY)
      for what, columns in (("forces", FORCES), ("torques", TORQUES))),
    Fault("left wrench 25 ms late from the middle on", "timing",
          from_the_middle_on(altered(wrench("left"), lambda values: np.append(values[:5], values[:-5]))), DELAY),
    Fault("left wrench 40 ms late at times", "timing", late_at_times(wrench("left"), 8), DELAY),
    Fault("wrenches' clock 0.1 % slow", "timing", drifting_clock(wrench(), 1e-3), (*DELAY, "clock", "drift")),
    Fault("wrenches filtered at 5 Hz", "timing", low_passed(wrench(), 5), (*DELAY, "filter")),
    Fault("stamps rounded to 10 ms", "timing", timed(lambda time: np.round(time, 2)), ("time",)),
    Fault("stamps jitter by half a sample", "timing",
          timed(lambda time: time + 0.0024 * np.sin(1e3 * np.arange(len(time)))), ("uneven", "jitter", "time")),
)  # fmt: skip

SATURATION = (
    Fault("torques clipped at 50 %", "saturation", clipped(TORQUES, 0.5), STUCK),
    Fault("torques clipped at 85 %", "saturation", clipped(TORQUES, 0.85), STUCK),
    Fault("left torque y clipped at 40 %", "saturation", clipped(wrench("left", quantity=r"torque\.y"), 0.4), STUCK),
    Fault("forces z clipped at 80 %", "saturation", clipped(wrench(quantity=r"force\.z"), 0.8), STUCK),
    Fault("left force z clipped at 50 %", "saturation", clipped(wrench("left", quantity=r"force\.z"), 0.5), STUCK),
    Fault("gyroscope clipped at 30 %", "saturation", clipped(GYROSCOPE, 0.3), STUCK),
    Fault("torques bend by 10 %", "saturation", bent(TORQUES, 0.1), (*STUCK, "bend")),
    Fault("torques dead below 3 %", "saturation", dead_below(TORQUES, 0.03), (*STUCK, "dead band")),
    Fault("torques in steps of 1.5 %", "saturation", in_steps(TORQUES, 0.015), (*STUCK, "steps")),
    Fault("torques with 1 % hysteresis", "saturation", with_hysteresis(TORQUES, 0.01), ("hysteresis", *DELAY)),
    Fault("play of 0.1 deg in the left ankle's encoders", "saturation",
          one_after_another(*(with_play(encoder("left", place=place, quantity="position"), 0.1 / DEGREES)
                              for place in (ANKLE_PITCH, ANKLE_ROLL))), ("play",)),
)  # fmt: skip


def _stuck_encoder(name: str, place: int, when: str, start: float, stop: float) -> Fault:
    """A position that repeats; its velocity, derived from it, is zero there."""
    position, velocity = (encoder("left", place=place, quantity=each) for each in ("position", "velocity"))
    change = one_after_another(
        overwritten(position, start, stop), overwritten(velocity, start, stop, value=0.0)
    )
    return Fault(f"left {name} stuck{when}", "freezing", change, STUCK)


ENCODERS = (("knee", KNEE), ("ankle pitch", ANKLE_PITCH), ("ankle roll", ANKLE_ROLL))
WHEN = (("", 0.0, 1.0), (" from the middle on", 0.5, 1.0), (" for a tenth", 0.45, 0.55))
FREEZING = (
    Fault("left wrench held for a tenth", "freezing", overwritten(wrench("left"), 0.45, 0.55), STUCK),
    Fault("left wrench held from the middle on", "freezing", overwritten(wrench("left"), 0.5, 1), STUCK),
    Fault("left torque y held for a fifth", "freezing",
          overwritten(wrench("left", quantity=r"torque\.y"), 0.4, 0.6), STUCK),
    Fault("IMU held for a tenth", "freezing", overwritten(imu(), 0.45, 0.55), STUCK),
    Fault("orientation held for a fifth", "freezing", overwritten(ORIENTATION, 0.4, 0.6), (*STUCK, "gyroscope")),
    Fault("all joints held for a tenth", "freezing", overwritten(encoders(), 0.45, 0.55), STUCK),
    *(_stuck_encoder(*joint, *when) for joint, when in product(ENCODERS, WHEN)),
    *(Fault(f"left ankle pitch slips by {size} deg half way", "freezing",
            stepped(encoder("left", place=ANKLE_PITCH, quantity="position"), 0.5, np.radians(size)), ("jumps",))
      for size in (0.4, 1.5)),
    *(Fault(f"IMU loose by 5 mrad about {name}", "freezing", loose(0.005, axis), ("jumps", "loose"))
      for axis, name in enumerate("xy")),
    Fault("IMU on a soft mount, 2 mrad for each m/s²", "freezing", on_soft_mount(0.002), ("mount",)),
    *(Fault(f"left {name} stuck, velocity goes on", "freezing",
            overwritten(encoder("left", place=place, quantity="position"), 0, 1), STUCK) for name, place in ENCODERS),
)  # fmt: skip

GONE = ("not recorded", "NaN", "gap", "dropout", "zero", *STUCK)
DROPOUTS = (
    Fault("left wrench empty for a tenth", "dropouts", overwritten(wrench("left"), 0.45, 0.55, np.nan), GONE),
    Fault("wrenches empty, 0.2 s every 5 s", "dropouts", dropouts(wrench(), np.nan), GONE),
    Fault("left wrench zero, 0.2 s every 5 s", "dropouts", dropouts(wrench("left"), 0.0), GONE),
    Fault("wrenches zero, 0.05 s every s", "dropouts", dropouts(wrench(), 0.0, 10, 200), GONE),
    Fault("IMU zero, 0.2 s every 5 s", "dropouts", dropouts(imu(), 0.0), (*GONE, "quaternion")),
    Fault("left ankle pitch zero, 0.2 s every 5 s", "dropouts",
          dropouts(encoder("left", place=ANKLE_PITCH), 0.0), (*GONE, "joint")),
    Fault("rows missing, 1 s every 10 s", "dropouts", rows(lambda time: time % 10 > 1), GONE),
    Fault("left wrench repeats a fifth, up to 50 ms", "dropouts", lost_frames(wrench("left"), 0.2, 10),
          (*GONE, *DELAY)),
    Fault("every third row missing", "dropouts", rows(lambda time: np.arange(len(time)) % 3 > 0), ("uneven", *GONE)),
)  # fmt: skip

SLOW = ("rate", r"\bHz\b", "slow", "sampl", *DELAY, *STUCK)
SAMPLING = (
    *(Fault(f"log at {rate} Hz", "sampling", thinned(rate), SLOW) for rate in (5, 10, 25, 50)),
    Fault("IMU at 50 Hz, held", "sampling", every_nth_held(imu(), 4), SLOW),
    Fault("wrenches at 50 Hz, held", "sampling", every_nth_held(wrench(), 4), SLOW),
    Fault("wrenches at 10 Hz, held", "sampling", every_nth_held(wrench(), 20), SLOW),
    Fault("joints at 25 Hz, held", "sampling", every_nth_held(encoders(), 8), SLOW),
    Fault("3 s of each log", "sampling", rows(lambda time: (time > 12) & (time < 15)), ("serve", "short", "delay")),
)  # fmt: skip

GAINS = (
    Fault("wrenches +10 %", "gains", scaled(wrench(), 1.1), GAIN),
    Fault("wrenches -10 %", "gains", scaled(wrench(), 0.9), GAIN),
    Fault("wrenches +5 %", "gains", scaled(wrench(), 1.05), GAIN),
    Fault("left wrench +10 %", "gains", scaled(wrench("left"), 1.1), GAIN),
    Fault("torques +10 %", "gains", scaled(TORQUES, 1.1), GAIN),
    Fault("left torques -10 %", "gains", scaled(wrench("left", quantity="torque.*"), 0.9), GAIN),
    Fault("forces +10 %", "gains", scaled(FORCES, 1.1), GAIN),
    Fault("left torque y +20 %", "gains", scaled(wrench("left", quantity=r"torque\.y"), 1.2), GAIN),
    Fault("gyroscope +10 %", "gains", scaled(GYROSCOPE, 1.1), (*GAIN, "gyroscope")),
    Fault("left knee +5 %", "gains", scaled(encoder("left", place=KNEE), 1.05), (*GAIN, "joint")),
    Fault("hip rolls +3 %", "gains", scaled(encoder(place=HIP_ROLL), 1.03), (*GAIN, "joint")),
)  # fmt: skip

TARES = (
    Fault("wrenches tared under load", "tares", tared(wrench()), TARE),
    Fault("left wrench tared under load", "tares", tared(wrench("left")), TARE),
    Fault("torques tared under load", "tares", tared(TORQUES), TARE),
    Fault("left torque y zero off by 10 N·m", "tares", shifted(wrench("left", quantity=r"torque\.y"), 10.0), TARE),
    Fault("left force z zero off by 60 N", "tares", shifted(wrench("left", quantity=r"force\.z"), 60.0), TARE),
    Fault("left knee zero off by 3 deg", "tares",
          shifted(encoder("left", place=KNEE, quantity="position"), 3 / DEGREES),
          (*TARE, "encoder", "joint", "leans")),
    Fault("left ankle pitch zero off by 3 deg", "tares",
          shifted(encoder("left", place=ANKLE_PITCH, quantity="position"), 3 / DEGREES),
          (*TARE, "encoder", "joint", "leans")),
)  # fmt: skip

OF_LOGS = (
    *UNITS,
    *SIGNS,
    *FRAMES,
    *NAMES,
    *TIMING,
    *SATURATION,
    *FREEZING,
    *DROPOUTS,
    *SAMPLING,
    *GAINS,
    *TARES,
)
