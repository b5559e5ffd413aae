"""A motion played on the twin before any robot plays it."""
