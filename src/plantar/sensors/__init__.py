"""What a robot's sensors get wrong, told by Newton's law and gravity: delays, clocks, gains, zeros, tilt."""
