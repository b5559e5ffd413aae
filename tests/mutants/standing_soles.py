"""Mutants of what soles that stand say where no accelerometer is recorded, and of memories that small motions hide."""

from __future__ import annotations

from mutant import Mutant

IMU = ("contact/test_standing_imu.py",)
NEWTON = ("sensors/test_newton_euler.py",)
TOLD = ("sensors/delays/test_told_delay.py",)
MOMENTS = ("sensors/moments/test_torque_gains.py",)
SHARED = ("feet/test_shared_hysteresis.py",)

STANDING_SOLES = (
    Mutant(
        "contact/standing_imu.py", "the sole's acceleration", "world = -np.einsum", "world = np.einsum", IMU
    ),
    Mutant("contact/standing_imu.py", "no gravity", "[0.0, 0.0, GRAVITY]", "[0.0, 0.0, 0.0]", IMU),
    Mutant(
        "contact/standing_imu.py", "hanging robots too", "LEAST_LOAD * robot.mass", "0.0 * robot.mass", IMU
    ),
    Mutant(
        "contact/standing_imu.py",
        "encoders the other way",
        "self.proper(self.period) - self.proper(-self.period)",
        "self.proper(-self.period) - self.proper(self.period)",
        IMU,
    ),
    Mutant("contact/standing_imu.py", "turned back", "-1, 3)) @ turn", "-1, 3)) @ turn.T", IMU),
    Mutant("contact/standing_imu.py", "half a slope", "/ (2 * TURN)", "/ TURN", IMU),
    Mutant(
        "dynamics/inertial_motion.py",
        "encoders move no soles",
        "+= encoders_late * signals.by_encoders[kept]",
        "-= encoders_late * signals.by_encoders[kept]",
        NEWTON,
    ),
    Mutant(
        "sensors/newton_euler.py",
        "no draws of turned mounts",
        "errors = turned + errors if len(errors) else turned",
        "errors = errors if len(errors) else 0 * turned",
        NEWTON,
    ),
    Mutant(
        "sensors/newton_sides.py",
        "noise counts as well",
        "STOOD = (0.15, 4.0)",
        "STOOD = (0.15, 400.0)",
        NEWTON,
    ),
    Mutant(
        "sensors/delays/refined_delays.py",
        "steps that waver",
        "told = told if taken < WAVERING - 1 else step.told",
        "told = told",
        ("sensors/delays/test_edges.py",),
    ),
    Mutant(
        "sensors/delays/sensor_delay.py",
        "soles raise doubt",
        "missed & ~pushed & alone[searched]",
        "missed & ~pushed",
        ("sensors/delays/test_edges.py",),
    ),
    Mutant(
        "sensors/delays/sensor_delay.py", "soles on rock", "SOLES_GIVE = 0.0005", "SOLES_GIVE = 0.0", TOLD
    ),
    Mutant(
        "sensors/delays/lagged_log.py",
        "lags of each log's own",
        "lags: Array = STEP *",
        "lags: Array = thin.period *",
        ("sensors/delays/test_lagged_log.py",),
    ),
    Mutant(
        "sensors/moments/law_rows.py",
        "about the root",
        "rows[..., TORQUE] - np.cross(centre, rows[..., FORCE])",
        "rows[..., TORQUE]",
        MOMENTS,
    ),
    Mutant(
        "sensors/moments/law_rows.py",
        "rows without forces",
        "range(6) if centre is None else range(6)[TORQUE]",
        "range(6)",
        MOMENTS,
    ),
    Mutant("feet/shared_hysteresis.py", "small is larger", "ALIKE = 2.0", "ALIKE = 3.0", SHARED),
    Mutant(
        "feet/fit/worth.py",
        "put back without a caution",
        "caution=NOT_EXCLUDED if fit.hidden_share else fit.choice.caution",
        "caution=fit.choice.caution",
        SHARED,
    ),
    Mutant("feet/fit/worth.py", "put back as sure", ", hidden_share=fit.hidden_share)", ")", SHARED),
    Mutant(
        "estimation/errors_in_variables.py",
        "a parabola of ten seconds",
        "SECOND = 1.0",
        "SECOND = 10.0",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "feet/interval_width/systematic.py",
        "feet that stand know their angle",
        "        _angle_errors(tangent),\n",
        "        *([_angle_errors(tangent)] if tangent.steps else []),\n",
        ("feet/interval_width/test_systematic.py",),
    ),
)
