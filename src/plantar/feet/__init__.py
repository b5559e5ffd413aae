"""Stiffness, damping and offset of each foot (eq. 4 to 7)."""
