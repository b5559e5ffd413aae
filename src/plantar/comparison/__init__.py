"""Do the exported feet move as the robot did? A log's joint motion in a simulator, beside what was recorded."""
