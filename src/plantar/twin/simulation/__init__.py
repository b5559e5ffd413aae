"""The twin's physics: scene, rubber, steps, rollouts."""
