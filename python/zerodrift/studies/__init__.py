"""Questions that take several runs: how wrong is one, what does accuracy cost, what survives, is a system right."""
