"""The identifications, each a short story in the paper's order."""
