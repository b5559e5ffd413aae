"""Forty careless changes, drawn from the source alone, before anybody looked at the tests of these rooms."""

from __future__ import annotations

from mutant import Mutant

ESTIMATION = (
    Mutant(
        "estimation/residual_covariance.py", "the mean counts as a cosine",
        "np.arange(1, min(cosines, count - 1) + 1)", "np.arange(min(cosines, count - 1))",
    ),
    Mutant(
        "estimation/residual_covariance.py", "half as many cosines",
        "round(2 * SCORE_BANDWIDTH * duration)", "round(SCORE_BANDWIDTH * duration)",
    ),
    Mutant(
        "estimation/residual_covariance.py", "Welch and Satterthwaite without the square",
        "np.sum(variances**2 / freedoms, axis=0)", "np.sum(variances / freedoms, axis=0)",
    ),
    Mutant(
        "estimation/least_squares.py", "white variance over rows, not degrees of freedom",
        "max(total.rows - total.rank - forgotten, 1)", "max(total.rows, 1)",
    ),
    Mutant(
        "estimation/delays/delay.py", "the model's error without its square root",
        "MODEL_ERROR * np.sqrt(power / _dots(rate_p, rate_p))", "MODEL_ERROR * (power / _dots(rate_p, rate_p))",
    ),
    Mutant(
        "estimation/delays/delay.py", "no longest delay where a pair is tried for closing",
        "np.clip(delay, -LONGEST, LONGEST)[..., None, None]", "delay[..., None, None]",
    ),
    Mutant(
        "estimation/errors_in_variables.py", "noise of one sample instead of all",
        "one.rows * one.noise", "one.noise",
    ),
    Mutant(
        "estimation/errors_in_variables.py", "offsets move the wrong way",
        "-float(mean @ change)", "float(mean @ change)",
    ),
    Mutant(
        "estimation/velocity_drift.py", "variances for deviations",
        "np.sqrt(_core.drift_variance(weight, *chain))", "_core.drift_variance(weight, *chain)",
    ),
    Mutant(
        "estimation/delays/sensor_delays.py", "cells weighed by their noise, not by their length too",
        "freedom / (squares - (missing", "1 / (squares - (missing",
    ),
)  # fmt: skip

MODEL_SELECTION = (
    Mutant(
        "model_selection/cross_validation.py", "a dominant recording is held out as a whole",
        "moved.max() <= DOMINANT * moved.sum()", "moved.max() <= moved.sum()",
    ),
    Mutant(
        "model_selection/grid.py", "a held-out piece gets the first recording's offset",
        "fits.offsets[shape, pieces.data_set[held], None]", "fits.offsets[shape, 0 * pieces.data_set[held], None]",
    ),
    Mutant(
        "model_selection/selection.py", "a term is told from zero by its variance",
        "TOLD * np.sqrt(fit.covariance[k, k])", "TOLD * fit.covariance[k, k]",
    ),
    Mutant(
        "model_selection/selection.py", "a refused model is told of for any gain",
        "else TELLING_GAIN))", "else 0.0))",
    ),
    Mutant(
        "model_selection/variable_projection.py", "the initial state's slope has the wrong sign",
        "(variants[1] - variants[2])[self.run]", "(variants[2] - variants[1])[self.run]",
    ),
    Mutant(
        "model_selection/model_fit.py", "white variance of a shape scaled like a deviation",
        "linear.inverse_diagonal() * scale**2", "linear.inverse_diagonal() * scale",
    ),
    Mutant(
        "model_selection/model_fit.py", "a shape near its range's end counts as inside",
        "self.shape[place] > (1 - AT_LIMIT) * self.limits", "self.shape[place] > self.limits",
    ),
    Mutant(
        "estimation/slow_drift.py", "drift about the first sample, so that means change",
        "columns -= columns.mean(axis=1, keepdims=True)", "columns -= columns[:, :1]",
    ),
    Mutant(
        "model_selection/partialled_out.py", "offsets' influence with the wrong sign",
        "offsets = -own @ slopes.T", "offsets = own @ slopes.T",
    ),
)  # fmt: skip

EXCLUSION = (
    Mutant(
        "feet/exclusion/edge_rolling.py", "damping adds to the excess angle",
        "(bush.torque - damping * bush.rate) / stiffness", "(bush.torque + damping * bush.rate) / stiffness",
    ),
    Mutant(
        "feet/exclusion/outliers.py", "a harmless misfit is left out",
        "np.maximum(FAR_MISFITS * scale, WORTH * spread)", "FAR_MISFITS * scale",
    ),
    Mutant(
        "feet/exclusion/outliers.py", "bins taken for seconds",
        "(run.stop - run.start) * BIN <= LONGEST", "(run.stop - run.start) <= LONGEST",
    ),
    Mutant(
        "feet/exclusion/slip.py", "a foot that stands alone gets the other one's speed",
        "faster = both & ~(", "faster = ~(",
    ),
    Mutant(
        "feet/exclusion/sole_velocity.py", "the attitude's noise is added twice",
        "arm - cross(noise_of_attitude, arm)", "arm + cross(noise_of_attitude, arm)",
    ),
    Mutant(
        "feet/exclusion/sole_velocity.py", "friction turned by minus the heading",
        "[c * along - s * across, s * along + c * across,", "[c * along + s * across, c * across - s * along,",
    ),
    Mutant(
        "feet/exclusion/torque_saturation.py", "the window holds on one side only",
        "np.abs(angle) > settings.window", "angle > settings.window",
    ),
)  # fmt: skip

FIT = (
    Mutant(
        "feet/fit/compliances.py", "the feet's likeness without its square",
        "0.25 * (1 - gain) ** 2 *", "0.25 * (1 - gain) *",
    ),
    Mutant(
        "feet/fit/vertical_stiffness.py", "deviation compared with a variance",
        "np.var(clear[:, :2], axis=0) > RELIABLE", "np.std(clear[:, :2], axis=0) > RELIABLE",
    ),
    Mutant(
        "feet/interval_width/yaw_zero.py", "sine of roll instead of pitch",
        "one.bushes[fit.foot].deflection[:, 0]", "one.bushes[fit.foot].deflection[:, 1]",
    ),
    Mutant(
        "feet/interval_width/cause.py", "degrees of freedom from deviations, not variances",
        "np.array([np.diag(covariance), added**2])", "np.array([np.diag(covariance), added])",
    ),
    Mutant(
        "feet/fit/axis_fit.py", "all stances together taken for the usual one",
        "seconds / len(stances) > LONGEST_STANCE", "seconds > LONGEST_STANCE",
    ),
    Mutant(
        "feet/regression/model_columns.py", "columns of a model with memory unfiltered",
        "low_pass(columns, recording.period, recording.cutoff, SHORTEST_FITTED_RUN)", "columns",
    ),
)  # fmt: skip

ASSESSMENT = (
    Mutant(
        "feet/assess/contradiction.py", "motions that hardly load an axis contradict it",
        "row.zero_mean_abs > least", "row.zero_mean_abs > 0",
    ),
    Mutant(
        "feet/assess/parameter_rows.py", "damping counts as negative when it may be",
        "damping + 2 * float(fit.std[1]) < 0", "damping - 2 * float(fit.std[1]) < 0",
    ),
    Mutant(
        "feet/assess/diagnosis.py", "shares of deviations, not of variances",
        "float(cause.share[place] / total) ** 2", "float(cause.share[place] / total)",
    ),
    Mutant(
        "feet/regression/prediction.py", "the trivial predictor sees the samples that are scored",
        "np.full(len(torque), np.mean(torque[first]))", "np.full(len(torque), np.mean(torque[used & ~first]))",
        tests=("feet/assess/test_scores.py",),
    ),
    Mutant(
        "results/scores.py", "the first second of the log, not of the stance", "time < time[used][0]", "time < time[0]",
    ),
)  # fmt: skip

WHOLE_BODY = (
    Mutant(
        "whole_body/scores.py", "the CAD is compared with the prediction",
        "np.mean((measured - cad) ** 2)", "np.mean((predicted - cad) ** 2)",
    ),
    Mutant(
        "whole_body/covariance.py", "scores weighed once", "fit.weights[row] ** 2 *", "fit.weights[row] *",
    ),
    Mutant(
        "whole_body/covariance.py", "the regularisation's own error without the square",
        "regularisation**2 * float(moved @ moved)", "regularisation * float(moved @ moved)",
    ),
)  # fmt: skip

DRAWN = (*ESTIMATION, *MODEL_SELECTION, *EXCLUSION, *FIT, *ASSESSMENT, *WHOLE_BODY)
