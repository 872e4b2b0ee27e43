/* Assembly: from a reference configuration to positions in which all joints are closed, and velocities that they allow.
 *
 * The unknowns are absolute coordinates, of the mass centres, so that the start is the same whatever coordinates a simulation takes. Steps
 * are measured in rad and parts of the mechanism's length, and have minimum norm in the mass metric. Rows may be redundant.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#ifndef ZD_ASSEMBLY_H
#define ZD_ASSEMBLY_H

#include "given.h"

/* Each returns an outcome, or a negative status of the core: no memory, or a failed evaluation of the system. p (nq,). */

/* Nearest positions that satisfy all constraints and held targets, and approach wished ones; p: the reference configuration on entry */
int zd_assemble_positions(const zd_assembly_given *given, double *p);
/* Positions that satisfy drives and held targets, led there from closed ones, while staying targets keep their values. */
int zd_assembly_lead(const zd_assembly_given *given, double *p);
/* Nearest positions that satisfy all constraints, by Newton's method; p is unchanged without these. */
int zd_assembly_project(const zd_assembly_given *given, double *p);
/* Positions in which the sum of squares of the residuals of all constraints, in m and rad, is least */
int zd_assembly_minimize(const zd_assembly_given *given, double *p);
/* ZD_ASSEMBLED if p satisfies all constraints and held targets */
int zd_assembly_check(const zd_assembly_given *given, const double *p);
/* v (nv,) <- minimum-norm velocities that satisfy all constraints and held targets and approach wished ones */
int zd_assemble_velocities(const zd_assembly_given *given, const double *p, double *v);

#endif
