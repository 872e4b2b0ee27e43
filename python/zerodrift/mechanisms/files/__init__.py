"""Mechanisms as JSON, and from JSON."""
