"""Studies of a system at one state: tangent space, derivatives, equilibrium, linearization, kinematics, inverse dynamics."""
