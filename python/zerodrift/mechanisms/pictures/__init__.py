"""Shapes, outlines and arrows of a mechanism in its poses, for `zerodrift.plot` and the player."""
