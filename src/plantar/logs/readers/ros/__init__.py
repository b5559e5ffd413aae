"""ROS bags: containers (MCAP, SQLite, ROS 1), message layouts, topics."""
