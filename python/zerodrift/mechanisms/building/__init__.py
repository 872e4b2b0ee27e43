"""Verbs of `Mechanism`: each checks its arguments and adds an element."""
