"""Inertial parameters without joint torques (eq. 2), friction of the joints (eq. 3)."""
