"""Where the width of an interval comes from: the residuals of the fit, and causes that no residual shows.

`cause` is one of them, and `systematic` adds up most; `robot_causes`, `between_recordings`, `between_walks`,
`force_gain`, `imu_turn`, `yaw_zero` and `encoder_delay` hold one kind of cause each. What the residuals themselves say,
autocorrelated as they are, is in `estimation.residual_covariance`.
"""
