"""What fitted feet show of the other sensors, and the logs with that put right, to be fitted again."""
