"""Mechanisms of the core, in the plane and in space: their tables, planned forms, geometry and compiled terms."""
