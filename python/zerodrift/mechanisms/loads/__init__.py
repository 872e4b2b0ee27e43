"""Forces between teeth, and measures of several bodies and of the ground."""
