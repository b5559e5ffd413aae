"""Feet in the control loop: the native estimator tick by tick, and logs replayed through it."""
