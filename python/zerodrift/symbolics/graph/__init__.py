"""Expressions of a system as a graph of nodes, and its elementary operations, each of them once."""
