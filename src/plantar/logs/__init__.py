"""Logs in and out: one table of named columns, whatever the format."""
