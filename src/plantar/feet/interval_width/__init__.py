"""Where the width of an interval comes from: the residuals of the fit, and causes that no residual shows.

`cause` is one of them, and `systematic` adds up most; `between_recordings`, `between_walks`, `force_gain`, `yaw_zero`,
`sensor_causes`, `slip_angle` and `joint_compliance` hold one kind of cause each. What the residuals themselves say,
autocorrelated as they are, is in `estimation.residual_covariance`.
"""
