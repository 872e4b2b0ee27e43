"""Methods of `Mechanism` that check their arguments and add an element."""
