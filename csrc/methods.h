/* Entries of the tables of systems, formulations, integrators and corrections, and dimensions of mechanisms, in their order. A new entry is
 * a new file and one word here; a program that needs few of them is built with a list of its own. */
#pragma once

#define ZD_SYSTEM_LIST(X) X(zd_four_bar) X(zd_oscillator) X(zd_pendulum) X(zd_knife_edge)
#define ZD_FORMULATION_LIST(X) X(zd_augmented) X(zd_nullspace) X(zd_schur) X(zd_mixed) X(zd_independent)
#define ZD_INTEGRATOR_LIST(X) \
    X(zd_euler) X(zd_midpoint) X(zd_heun) X(zd_rk4) X(zd_dormand_prince) X(zd_dop853) X(zd_extrapolation) X(zd_trapezoidal) \
    X(zd_radau) X(zd_rattle) \
    X(zd_taylor)
#define ZD_CORRECTION_LIST(X) X(zd_baumgarte_row) X(zd_projection_row) X(zd_energy_row)    /* in the order they are applied */
#define ZD_DIMENSION_LIST(X) X(zd_block_plane) X(zd_block_space)
