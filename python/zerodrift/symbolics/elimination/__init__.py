"""Equations of motion solved in closed form: constraints are eliminated along an order of pivots."""
