"""A foot as points under its sole that push on the ground: for models that can take no joints."""
