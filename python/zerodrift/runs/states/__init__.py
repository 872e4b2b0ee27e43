"""One state (t, p, v) of a system: operations on it, and any quantity by its name."""
