"""Readings that cannot be: channels, IMU, wrenches of a robot that stands."""
