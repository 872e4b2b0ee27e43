"""Mechanisms derived with SymPy and evaluated by compiled C.

From expressions to a system, in the order of the rooms:

1. `graph`: `from_sympy` translates expressions to nodes, `derivation` forms the terms of (1)-(6) with derivatives from
   `gradient`, and `lowering` reduces them to elementary operations, each computed once.
2. `elimination`: the equations of motion in closed form, along orders of pivots that `pivot_orders` chooses.
3. `emit`: C and Python sources. `splitting` divides long functions, `lane_writer` writes for SIMD lanes.
4. `compile`: `compilers` finds a C compiler, `shared_library` runs it, `cache` stores the results on disk.

`define` has `symbolic`, `mechanics` has `from_mechanics`, and `system` has the class that both return.
"""
