#include "gaps.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"

zd_gaps zd_gaps_create(zd_arena *arena, const zd_system *system, int groups)
{
    if (!groups) return (zd_gaps){NAN, NULL, NULL, NULL, NULL};
    return (zd_gaps){NAN, zd_arena_doubles(arena, system->nq), zd_arena_doubles(arena, system->nv), zd_arena_doubles(arena, groups),
                     zd_arena_doubles(arena, groups)};
}

int zd_gaps_find(zd_gaps *self, const zd_phase_system *phase, double t, const double *p, const double *v)
{
    const zd_system *full = phase->full;
    if (t == self->t && !memcmp(p, self->p, full->nq * sizeof *p) && !memcmp(v, self->v, full->nv * sizeof *v)) return ZD_DONE;
    const int status = zd_phase_need(phase, ZD_PHI | ZD_C | ZD_PHI_T, t, p, v);
    self->t = status ? NAN : t;
    zd_copy_all(full->nq, p, self->p);
    zd_copy_all(full->nv, v, self->v);
    for (int g = 0; !status && g < full->groups; g++) {
        double rate;
        if (full->group[g].kind != ZD_ONE_SIDED) continue;
        zd_phase_slip(phase, g, v, &rate);
        self->gap[g] = zd_phase_gap(phase, g);
        self->rate[g] = full->group[g].sign * rate;
    }
    return status;
}

double zd_gaps_distance(const zd_gaps *before, const zd_gaps *after, int nv, const double *inverse_unit)
{
    double largest = 0;
    for (int i = 0; i < nv; i++) largest = fmax(largest, fmax(fabs(before->v[i]), fabs(after->v[i])) * inverse_unit[i]);
    return largest * (after->t - before->t);
}

int zd_gap_stays_open(const zd_phase_system *phase, const zd_gaps *before, const zd_gaps *after, int group)
{
    const enum zd_group_kind kind = phase->full->group[group].kind;
    const signed char state = phase->state[group];
    if (kind == ZD_TWO_SIDED || (kind == ZD_FRICTION && (state == ZD_OPEN || state == ZD_IDLE))) return 1;
    if (kind != ZD_ONE_SIDED || state != ZD_OPEN) return 0;
    const double h = after->t - before->t, change = after->gap[group] - before->gap[group];
    return fmin(before->gap[group], after->gap[group]) > fabs(h * before->rate[group] - change) + fabs(h * after->rate[group] - change);
}
