"""Initial positions and velocities that satisfy all joints and drives."""
