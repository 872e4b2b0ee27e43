"""Compiled functions and systems of users."""
