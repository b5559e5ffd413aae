"""Forty-one more careless changes, drawn from the source of the rooms that decide numbers, verdicts and exports."""

from __future__ import annotations

from mutant import Mutant

ESTIMATION = (
    Mutant(
        "estimation/residual_covariance.py", "the deviation's reach at one side's 95 %",
        "student_quantile(0.975, max(freedom, 1.0))", "student_quantile(0.95, max(freedom, 1.0))",
    ),
    Mutant(
        "estimation/residual_covariance.py", "relative deviations with the value's sign",
        "100 * std / abs(value)", "100 * std / value",
    ),
    Mutant(
        "estimation/errors_in_variables.py", "the louder of two bands is the noise",
        "found = np.minimum(wide, narrow)", "found = np.maximum(wide, narrow)",
    ),
    Mutant(
        "estimation/errors_in_variables.py", "the filter passes amplitudes, not powers",
        "np.mean(each**2)", "np.mean(each)",
    ),
    Mutant(
        "estimation/slow_drift.py", "half as many cosines follow a drift",
        "int(2 * length / DRIFT_PERIOD)", "int(length / DRIFT_PERIOD)",
    ),
    Mutant(
        "estimation/stance_least_squares.py", "the jackknife without its factor",
        "(groups - 1) / groups * away.T @ away", "away.T @ away / groups",
    ),
    Mutant(
        "estimation/stance_least_squares.py", "as free as stances are many, where few recordings widen them",
        "freedom = np.where(growth > 1, of_between, freedom)", "freedom = np.where(growth > 1, freedom, of_between)",
    ),
    Mutant(
        "estimation/stance_least_squares.py", "recordings that differ never widen what stances show",
        "np.sqrt(np.maximum(np.diag(between) / least, 1.0))", "np.sqrt(np.minimum(np.diag(between) / least, 1.0))",
    ),
    Mutant(
        "estimation/random_effects.py", "the prior of shares without its heavy tail",
        "-0.5 * (HEAVY + 1) * np.log1p((TRIED / max(usual, LEAST)) ** 2 / HEAVY)", "-0.5 * (TRIED / usual) ** 2",
    ),
    Mutant(
        "estimation/random_effects.py", "the first group differs by nothing",
        "np.eye(len(found.shares)) + 1.0", "np.eye(len(found.shares))",
    ),
)  # fmt: skip

EXCLUSION = (
    Mutant(
        "feet/exclusion/outliers.py", "a long stretch is a bad sample, too",
        "if (run.stop - run.start) * BIN <= LONGEST:", "if run.stop > run.start:",
    ),
    Mutant(
        "feet/exclusion/outliers.py", "however many samples are outliers",
        "found.sum() <= MOST * np.isfinite(missed).sum()", "found.any()",
    ),
    Mutant(
        "feet/exclusion/outliers.py", "what the filter spreads of an outlier stays",
        "margin = round(reach / period)", "margin = 0",
    ),
    Mutant(
        "feet/exclusion/outliers.py", "what the motion consists of is left out",
        ".min(axis=0).max() <= MOVING", ".min(axis=0).min() <= MOVING",
    ),
    Mutant(
        "feet/exclusion/torque_saturation.py", "the window is one-sided",
        "beyond = np.abs(angle) > settings.window", "beyond = angle > settings.window",
    ),
    Mutant(
        "feet/exclusion/torque_saturation.py", "angles are counted from zero, not from rest",
        "bush.deflection[:, column] - _resting(bush.deflection[used, column])", "bush.deflection[:, column]",
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py", "a zero of the torque does not move the edge",
        "border < margin + np.maximum(zero / load, inward)", "border < margin + inward",
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py", "guessed outlines are as good as measured ones",
        "settings.edge_margin + (inner if guessed else 0.0)", "settings.edge_margin",
    ),
)  # fmt: skip

VERDICTS = (
    Mutant(
        "feet/assess/verdicts.py", "terms of richer models are usable at any width",
        'return ("usable" if width < 2 * USABLE_WIDTH else "weak")', 'return ("usable")',
    ),
    Mutant(
        "feet/assess/verdicts.py", "a negative number is weak only",
        "if value <= 0 and interval[1] <= 0:", "if value <= 0 and interval[1] <= interval[0]:",
    ),
    Mutant(
        "feet/assess/verdicts.py", "few seconds are no reason for doubt",
        "if evidence.seconds < SHORT_SECONDS:", "if evidence.seconds < LEAST_SECONDS:",
    ),
    Mutant(
        "feet/assess/verdicts.py", "soles that lean for half a recording pass",
        "LEANING = 0.05", "LEANING = 0.5",
    ),
    Mutant(
        "signals/mean_changes.py", "a jump across a lift counts",
        "np.where(same, apart, 0.0) > far", "apart > far",
    ),
    Mutant(
        "feet/assess/zero_jumps.py", "any jump is worth a warning",
        "> WORTH * float(np.std(block.response))", "> 0.0",
    ),
    Mutant(
        "feet/assess/play.py", "an axis without play is told of the other's",
        "SOME * other.jump", "0.0 * other.jump",
    ),
    Mutant(
        "feet/assess/diagnosis.py", "residuals of any colour are the model's",
        "fit.std[place] > MODEL_SHARE * fit.white_std[place]", "fit.std[place] > fit.white_std[place]",
    ),
    Mutant(
        "feet/assess/diagnosis.py", "the remaining width as if variances were widths",
        "float(np.sqrt(max(0.0, 1 - shares[limit])))", "max(0.0, 1 - shares[limit])",
    ),
)  # fmt: skip

SCORES = (
    Mutant(
        "results/scores.py", "the first second begins with the log, not with its used samples",
        "time < time[used][0] + FIRST_SECOND", "time < time[0] + FIRST_SECOND",
    ),
    Mutant(
        "results/scores.py", "percent of the largest error",
        "largest, mean_abs = float(np.max(np.abs(measured)))", "largest, mean_abs = float(np.max(np.abs(error)))",
    ),
    Mutant(
        "feet/assess/scores.py", "seen motions count as unseen",
        '"direct" if recording.role == "fit" else "cross"', '"cross" if recording.role == "fit" else "direct"',
    ),
    Mutant(
        "results/usage.py", "used seconds are all seconds",
        "used[key] += duration", "used[key] = seconds[key]",
    ),
    Mutant(
        "results/feet_text.py", "motions count alike, however short",
        "sum(value * count for value, count in zip(values, samples, strict=True)) / max(sum(samples), 1)",
        "sum(values) / len(samples)",
    ),
)  # fmt: skip

SELECTION = (
    Mutant(
        "model_selection/selection.py", "a model that adds one clear term adds all of them",
        "return all(abs(fit.values[k])", "return any(abs(fit.values[k])",
    ),
    Mutant(
        "model_selection/selection.py", "a gain within its scatter is clear",
        "return enough and float(fall.sum()) > standard_error", "return enough",
    ),
    Mutant(
        "model_selection/selection.py", "a refused model that predicts better leaves the winner as it is",
        "if any(_clear(scores, errors, least_gain, simple=winner, rich=place) for place in refused)",
        "if False",
    ),
    Mutant(
        "model_selection/cross_validation.py", "one recording stands for two",
        "FEWEST_RECORDINGS = 3", "FEWEST_RECORDINGS = 2",
    ),
    Mutant(
        "model_selection/initial_state.py", "the memory's first state from all samples",
        "settling & (run_of == first))", "used & (run_of == first))",
    ),
)  # fmt: skip

EXPORT = (
    Mutant(
        "exporters/spring.py", "the rest pose on the wrong side",
        "return -self.offset / self.stiffness", "return self.offset / self.stiffness",
    ),
    Mutant(
        "exporters/spring.py", "an unidentifiable damping below its interval",
        "damping, said = float(low), \"the low end\"", "damping, said = damping, \"the low end\"",
    ),
    Mutant(
        "exporters/randomization.py", "a deviation twice as wide as its interval says",
        "/ (2 * NORMAL95)", "/ NORMAL95",
    ),
    Mutant(
        "exporters/randomization.py", "common causes by variance, not by deviation",
        'float(np.sqrt(shares[cause])) for cause in GAINS', 'float(shares[cause]) for cause in GAINS',
    ),
)  # fmt: skip

DRAWN_AGAIN = (*ESTIMATION, *EXCLUSION, *VERDICTS, *SCORES, *SELECTION, *EXPORT)
