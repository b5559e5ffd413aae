"""The controller of a walking robot: how it stands, what each foot should carry, how the legs bring it about."""
