"""What many small results say together: means that hold for other days and robots, and changes over time."""
