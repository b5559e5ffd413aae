"""The robot: its file, its model, its kinematic tree."""
