"""Careless changes of three more draws over all rooms that no test noticed then: limits, printed numbers and guards."""

from __future__ import annotations

from mutant import Mutant

LITERAL_EDGES = (
    Mutant(
        "results/usage.py", "seconds told twice as long", "({spent:.1f} s)", "({2 * spent:.1f} s)",
        ("results/test_edges.py",),
    ),
    Mutant(
        "results/numbers.py", "a tiny uncertainty loses its digits", "if half_width < 1e-6:", "if False:",
        ("results/test_edges.py",),
    ),
    Mutant(
        "results/reference.py", "a number without a value counts as one",
        'row.value is not None and row.verdict != "unidentifiable"', 'row.verdict != "unidentifiable"',
        ("results/test_reference.py",),
    ),
    Mutant(
        "faults/channels.py", "half of the doubt kills an encoder",
        "turned > SURE * doubt", "turned > SURE / 2 * doubt", ("faults/test_edges_of_encoders.py",),
    ),
    Mutant(
        "faults/joints/still_joints.py", "a spike in fifty samples is a motion", "MOST = (1.0, 99.0)",
        "MOST = (0.5, 99.0)", ("faults/test_edges_of_encoders.py",),
    ),
    Mutant(
        "faults/imu.py", "up may be half as wrong again", "RIGHT_ANGLE = np.radians(8)", "RIGHT_ANGLE = np.radians(12)",
        ("faults/test_edges_of_imu.py",),
    ),
    Mutant(
        "faults/gyroscope.py", "an accelerometer in g", "felt = acceleration[rows] / GRAVITY",
        "felt = acceleration[rows]", ("faults/test_gyroscope.py",),
    ),
    Mutant(
        "faults/standing.py", "leaning little up to thirty degrees", "PUSHED = 2.0", "PUSHED = 4.0",
        ("faults/test_edges_of_balance.py",),
    ),
    Mutant(
        "estimation/residual_covariance.py", "the upper half of the cosines keeps its sign",
        "turned.imag[2 * order > count] *= -1", "turned.imag[order > count] *= -1", ("estimation/test_edges.py",),
    ),
    Mutant(
        "estimation/stance_problem.py", "halves of five rows", "SHORTEST_HALF = 2", "SHORTEST_HALF = 5",
        ("estimation/test_edges.py",),
    ),
    Mutant(
        "estimation/delays/delay.py", "twice as late is a delay", "LONGEST = 0.05", "LONGEST = 0.1",
        ("estimation/test_edges.py",),
    ),
    Mutant(
        "contact/slip_indicator.py", "friction that half resists", "RESISTED = 0.3", "RESISTED = 0.15",
        ("contact/test_edges.py",),
    ),
    Mutant(
        "contact/stances.py", "five stances are a walk", "FEWEST_STANCES = 3", "FEWEST_STANCES = 5",
        ("contact/test_edges.py",),
    ),
    Mutant(
        "signals/spikes.py", "a step counts in full", "2 * steps > far", "steps > far",
        ("signals/test_edges_of_spikes.py",),
    ),
    Mutant(
        "signals/resampling.py", "the period for the rate", "even grid of {1 / period:.4g} Hz",
        "even grid of {period:.4g} Hz", ("signals/test_edges.py",),
    ),
    Mutant(
        "sensors/bandwidth.py", "a low-pass is told up to 18 Hz", "SLOWEST = 9.0", "SLOWEST = 18.0",
        ("sensors/test_edges.py",),
    ),
    Mutant(
        "sensors/delays/refined_delays.py", "sensors differ by twice as much", "LEAST_DISTINCT = 0.0015",
        "LEAST_DISTINCT = 0.003", ("sensors/delays/test_edges.py",),
    ),
    Mutant(
        "sensors/delays/refined_delays.py", "sensors are apart by half as much", "APART = 0.001", "APART = 0.0005",
        ("sensors/delays/test_edges.py",),
    ),
    Mutant(
        "sensors/delays/refined_delays.py", "half of what choices leave in doubt of a delay",
        "return UNIFORM * float(np.sqrt(np.max", "return 0.5 * UNIFORM * float(np.sqrt(np.max",
        ("sensors/delays/test_edges.py",),
    ),
    Mutant(
        "model_selection/data_sets.py", "turns between two samples are lost", "SAMPLES_PER_CYCLE_IN_STANCES = 32",
        "SAMPLES_PER_CYCLE_IN_STANCES = 16", ("model_selection/test_stances_fit.py",),
    ),
    Mutant(
        "feet/regression/regression_data.py", "crosstalk stays in what a memory is fitted to",
        "yaw_torque(recording, foot) + crosstalk * along_force(recording, foot, column)", "yaw_torque(recording, foot)",
        ("feet/regression/test_edges.py",),
    ),
    Mutant(
        "feet/assess/verdicts.py", "a share for per cent", "loses {100 * self.softened:.0f} %",
        "loses {self.softened:.0f} %", ("feet/assess/test_texts.py",),
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py", "twice the lean that disturbs", "LEAST_LEAN = 0.003", "LEAST_LEAN = 0.006",
        ("feet/exclusion/test_edges.py",),
    ),
    Mutant(
        "feet/fit/axis_fit.py", "a share for per cent", "explain {100 * explained:.4g} %", "explain {explained:.4g} %",
        ("feet/fit/test_edges.py",),
    ),
    Mutant(
        "feet/place/spread.py", "another foot's height is told too early", "ALIKE = 0.5", "ALIKE = 0.9",
        ("feet/place/test_edges.py",),
    ),
    Mutant(
        "feet/interval_width/force_gain.py", "one robot in fifteen has a faulty sensor", "FAULTY = 0.15",
        "FAULTY = 0.07", ("feet/interval_width/test_edges.py",),
    ),
    Mutant(
        "dynamics/base_motion.py", "a sole that stands feels no gravity", "still[:, 2] = GRAVITY",
        "still[:, 2] = 0.0", ("dynamics/test_base_motion.py",),
    ),
    Mutant(
        "model_selection/data_sets.py", "half of the samples of a cycle", "SAMPLES_PER_CYCLE = 7",
        "SAMPLES_PER_CYCLE = 4", ("model_selection/test_edges.py",),
    ),
    Mutant(
        "models/bush_model.py", "a spring of no stiffness", "bool(values[0] > 0) and all(", "True and all(",
        ("models/test_edges.py",),
    ),
    Mutant(
        "whole_body/folds.py", "twelve folds", "FOLDS = 6", "FOLDS = 12", ("whole_body/test_edges.py",),
    ),
    Mutant(
        "fleet/statistics/trend.py", "falling lines are never sure", "stdtr(freedom, -abs(slope) / std)",
        "stdtr(freedom, -slope / std)", ("fleet/statistics/test_edges.py",),
    ),
    Mutant(
        "exporters/__init__.py", "joints named where there are none",
        "[joints_note(feet)] if target in WITH_JOINTS else []", "[joints_note(feet)]", ("exporters/test_edges.py",),
    ),
    Mutant(
        "exporters/shapes.py", "links below the ankle stand above it",
        "corners @ place[:3, :3].T + place[:3, 3]", "corners @ place[:3, :3].T - place[:3, 3]",
        ("exporters/test_sole_level.py",),
    ),
    Mutant(
        "logs/readers/streams.py", "holes of five periods are bridged", "GAP_PERIODS = 2.5", "GAP_PERIODS = 5.0",
        ("logs/readers/test_edges.py",),
    ),
)  # fmt: skip
