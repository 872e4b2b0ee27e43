"""Mechanisms derived with SymPy and evaluated by compiled C.

From expressions to a system: `reading` takes SymPy's expressions into a `graph`, `derivation` finds the terms of (1)-(6) there,
by its `gradient`, `lowering` puts them into elementary operations, none of them twice, `emission` writes these as C, `large` what
is too long for one function, `compiling` has them compiled and kept, and `system` is what the user gets. `mechanics` reads what
`sympy.physics.mechanics` has set up.
"""
