"""Which bush model the data support: grid, variable projection, cross-validation."""
