"""Bush, force sensor, IMU and joints that are not where, or not as, the robot file says."""
