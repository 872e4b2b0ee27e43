"""Kinematic tracing: positions of a mechanism along its single degree of freedom, without forces."""
