"""Runs that go on: their beginning, their steps with inputs and control, and their end."""
