"""Faults of the sensors that shift an estimate: tilt error, delay."""
