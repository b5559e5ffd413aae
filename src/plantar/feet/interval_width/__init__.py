"""Where the width of an interval comes from: the residuals of the fit, and causes that no residual shows.

`systematic` adds them up; `robot_causes`, `between_recordings`, `between_walks`, `force_gain`, `imu_turn` and
`encoder_delay` hold one kind of cause each. What the residuals themselves say, autocorrelated as they are, is in
`estimation.residual_covariance`.
"""
