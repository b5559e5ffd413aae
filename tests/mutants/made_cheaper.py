"""Changes that must be noticed though the test's logs are fewer, shorter or fitted once for several claims."""

from __future__ import annotations

from mutant import Mutant

MADE_CHEAPER = (
    Mutant(
        "feet/interval_width/force_gain.py", "a gain in doubt widens by a quarter of what it may be",
        "(error.reach / NORMAL95) ** 2", "(error.reach / NORMAL95 / 4) ** 2",
        ("feet/interval_width/test_force_gain.py",),
    ),
    Mutant(
        "feet/interval_width/between_recordings.py", "what recordings differ by counts a tenth",
        "beyond = np.sqrt(", "beyond = 0.1 * np.sqrt(",
        ("feet/interval_width/test_between_recordings.py",),
    ),
    Mutant(
        "feet/place/bush_place.py", "a bush elsewhere is corrected the wrong way",
        "moved = -follows @ (place", "moved = follows @ (place", ("feet/place/test_bush_place.py",),
    ),
    Mutant(
        "feet/interval_width/systematic.py", "a suspected cube widens nothing",
        "def _suspected_hardening(tangent: Tangent) -> list[Cause]:\n",
        "def _suspected_hardening(tangent: Tangent) -> list[Cause]:\n"
        "    return []\n",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "feet/assess/data_faults.py", "a fault of the data takes nothing away",
        'if own and row.verdict == "usable":', "if False:", ("feet/assess/test_data_faults.py",),
    ),
    Mutant(
        "feet/foot_fit.py", "a fault of one axis loses the other too",
        "given_up |= why\n",
        "given_up |= {other: reason for other in left for reason in why.values()}\n",
        ("feet/test_foot_fit.py",),
    ),
    Mutant(
        "sensors/delays/sensor_delay.py", "the encoders' delay is forgotten",
        "dict(stored.feet), stored.encoder_delay)", "dict(stored.feet), 0.0)", ("feet/test_validate.py",),
    ),
    Mutant(
        "feet/exclusion/outliers.py", "short stretches are taken for motion",
        "LONGEST = 1.0", "LONGEST = 0.0", ("feet/exclusion/test_outliers.py",),
    ),
    Mutant(
        "estimation/stance_least_squares.py", "deviations of stances a third too small",
        "return covariance + towards.unsure, freedom", "return covariance / 2 + towards.unsure, freedom",
        ("estimation/test_stance_least_squares.py",),
    ),
    Mutant(
        "estimation/delays/delay.py", "a late signal is moved the other way",
        "np.clip(delay, -LONGEST, LONGEST)[", "np.clip(-delay, -LONGEST, LONGEST)[",
        ("estimation/delays/test_delay.py",),
    ),
    Mutant(
        "model_selection/model_fit.py", "deviations of all values a third of what they are",
        "linear.inverse_diagonal() * scale**2", "linear.inverse_diagonal() * scale**2 / 9",
        ("model_selection/test_model_fit.py",),
    ),
    Mutant(
        "twin/sensing/sensors.py", "sensors without delay are late by a sample",
        "    if delay == 0.0:\n        return values\n",
        "    if delay == 0.0:\n        return np.roll(values, 1, axis=0)\n",
        ("twin/sensing/test_sensors.py",),
    ),
)  # fmt: skip
