"""Bush, force sensor and IMU that are not where, or not as, the robot file says."""
