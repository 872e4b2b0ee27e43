/* Reach of drives: the dead point at which joints no longer let a driven coordinate move on.
 *
 * A motion is followed from position to position, in ever smaller parts of the time ahead, to the last one that satisfies all constraints. A
 * drive ends there if its coordinate goes on steadily, and if without it the others can be satisfied a little later.
 */
#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "../check.h"
#include "given.h"
#include "problem.h"

static const double LONGEST = 0.25;         /* move in a part of the time, at most, in rad or parts of the mechanism's length */
static const double SMALLEST_PART = 1e-12;  /* relative to the time, or to the time ahead */
static const double LATER = 1e-6;           /* relative to the time ahead: when the motion goes on without a drive, but not with it */
static const double STEADY = 1e-6;          /* residual of a drive after the smallest part, relative to its size: larger ones are jumps */
enum { MAX_VELOCITIES = 300, SIZE = 400 };

static const zd_conditions ALL = {.choice = ZD_OF_ALL};

typedef struct reach {
    zd_assembly_problem given;
    zd_assembly assembly;
    const int *measure;     /* (mh,): of the driven coordinate; -1: not known */
    int *role;              /* (mh,): of `given` */
    double *p;              /* (nq,): last position found */
} reach;

/* to <- position at a time, next to the last one; returns 0 if there is none. `is_far`: Newton's method alone may not find it. */
static int follow(reach *self, double t, int is_far, double *to)
{
    zd_assembly *assembly = &self->assembly;
    const zd_system *system = assembly->system;
    self->given.t = t;
    assembly->status = assembly->is_known[0] = 0;   /* user functions may fail at this time only */
    zd_copy_all(system->nq, self->p, assembly->found);
    if (is_far) zd_assembly_least_squares(assembly, &ALL, assembly->found);
    if (!zd_assembly_newton(assembly, &ALL, assembly->found)) return 0;
    zd_displacement(system, assembly->found, self->p, assembly->x);
    for (int i = 0; i < system->nv; i++)
        if (!(fabs(assembly->x[i]) <= LONGEST * assembly->scale[i])) return 0;
    zd_copy_all(system->nq, assembly->found, to);
    return 1;
}

/* Moves to the last time, not later than t, at which there is a position next to p; returns 0 if there is none. */
static int begin(reach *self, double t, double ahead)
{
    for (double back = 0x1p-40 * ahead; back <= ahead; back *= 2)
        if (follow(self, t - back, 1, self->p)) return 1;
    return 0;
}

/* Follows the motion to its end; returns 1 if it comes to a dead point before. */
static int has_dead_point(reach *self, double end, double ahead)
{
    const double least = SMALLEST_PART * fmax(fabs(end), ahead);
    double t = self->given.t, part = end - t;
    while (end - t > least) {
        if (follow(self, t + part, 0, self->p)) {
            t += part;
            part = fmin(2 * part, end - t);
        } else if (part > least) part /= 2;
        else return 1;
    }
    return 0;
}

/* Writes which drives end here: those that move steadily, and without which the motion goes on. */
static void explain(reach *self, double ahead, zd_complaint to)
{
    zd_assembly *assembly = &self->assembly;
    const zd_system *system = assembly->system;
    const double t = self->given.t;
    const zd_measured value = {.value = assembly->value};
    char name[SIZE], names[SIZE], limits[SIZE] = "";
    zd_complaint name_end = {names, SIZE}, limit_end = {limits, SIZE};
    zd_assembly_find(assembly, &ALL, self->p);
    zd_copy_all(system->mh, assembly->r, assembly->start);
    zd_assembly_find_rates(assembly, 0, self->p);
    for (int k = 0; k < system->mh; k++) {
        if (!(fabs(assembly->start[k]) < STEADY) || assembly->terms.Phi_t[k] == 0) continue;
        self->role[k] = ZD_ROLE_IGNORED;
        const int goes_on = follow(self, t + LATER * ahead, 0, assembly->begun);
        self->role[k] = ZD_ROLE_JOINT;
        if (!goes_on) continue;
        system->name_constraint(system->names, k, name, SIZE);
        zd_append(&name_end, "%s'%s'", name_end.size < SIZE ? " and " : "", name);
        if (self->measure[k] < 0) continue;
        system->measures->evaluate(system->data, self->given.inputs, self->measure[k], t, self->p, assembly->at_rest, NULL, NULL, &value,
                                   assembly->measures);
        zd_append(&limit_end, ", %s = %.9g", system->measures->measure[self->measure[k]].name, *assembly->value);
    }
    if (name_end.size < SIZE)
        zd_append(&to, "%s must not drive the mechanism beyond its reach: at t = %.9g it comes to a dead point%s, where the joints let no "
                  "motion go on; end before it, or drive another joint", names, t, limits);
}

int zd_assembly_explain_reach(const zd_assembly_problem *given, const double *p, const int *measure, double ahead, char *message,
                              int message_size)
{
    reach self = {.given = *given, .measure = measure, .role = zd_allocate(given->system->mh * sizeof(int))};
    self.given.role = self.role;
    const int status = !self.role ? ZD_NO_MEMORY : given->system->nv > MAX_VELOCITIES ? 0 : zd_assembly_open(&self.assembly, &self.given, p);
    if (self.assembly.block) {
        self.p = memcpy(self.assembly.led, p, given->system->nq * sizeof *p);
        if (begin(&self, given->t, ahead) && has_dead_point(&self, given->t + ahead, ahead))
            explain(&self, ahead, (zd_complaint){message, message_size});
        zd_assembly_close(&self.assembly, 0);
    }
    zd_release(self.role);
    return status;
}
