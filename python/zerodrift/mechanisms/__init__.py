"""Mechanisms from bodies and joints: what is drawn, and the systems that are made from it."""
