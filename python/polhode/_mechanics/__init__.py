"""Bodies, their states and their motion."""
