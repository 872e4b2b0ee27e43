"""Many runs of one system, or of a function that makes systems: parameters vary from run to run, and so may starts."""
