/* Rows of C, common to plane and space. Their loops stand in a header, so that each room compiles them with its own numerics. */
#pragma once

#include "../../linalg/small.h"
#include "planned.h"

typedef struct zd_constraint_numerics {
    const zd_planned_elements *elements;
    int nv;
    const int *at;                  /* (m,) offset of each row in C; NULL: C is (m, nv) */
    const int *is_elsewhere;        /* (m,) 1 if the row is not to be written; NULL: all are */
    /* Returns the value of the marker quantity of a term; adds its row, times a factor, to `to` unless that is NULL. */
    double (*read)(const zd_readings *at, int term, double factor, double *to);
    double (*bias)(const void *mechanism, const void *frame, int quantity);     /* second derivative of a marker quantity at vdot = 0 */
} zd_constraint_numerics;

/* Returns the sum of factors x, and adds that of factors times the marker quantities' rows to `to` unless that is NULL. */
ZD_INLINE double zd_constraint_readings(const zd_constraint_numerics *self, const zd_readings *readings, const zd_relation *row,
                                        const double *factors, double *to)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) sum += factors[i] * self->read(readings, row->first + i, factors[i], to);
    return sum;
}

ZD_INLINE double zd_row_biases(const zd_constraint_numerics *self, const zd_readings *readings, const zd_relation *row, const double *factors)
{
    const zd_quantity_term *term = self->elements->term + row->first;
    double sum = 0;
    for (int i = 0; i < row->terms; i++) sum += factors[i] * self->bias(readings->mechanism, readings->frame, term[i].quantity);
    return sum;
}

/* Phi, C, Phi_t and xi, as far as wanted, from a frame that is placed and moving; C must be zero before. A row is a combination of marker
 * quantities: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). Returns ZD_DONE or ZD_CALLBACK. */
ZD_INLINE int zd_rows_write(const zd_constraint_numerics *self, const zd_readings *readings, int want, double t, const zd_terms *out)
{
    for (int i = 0; i < self->elements->m; i++) {
        if (self->is_elsewhere && self->is_elsewhere[i]) continue;
        const zd_relation *row = self->elements->row + i;
        zd_combined all;
        const int status = zd_combine(self->elements, readings, row, t, &all), wants_Phi = (want & ZD_PHI) && i < self->elements->mh;
        if (status) return status;
        if (wants_Phi || want & ZD_C) {
            const int at = self->at ? self->at[i] : i * self->nv;
            const double sum = zd_constraint_readings(self, readings, row, all.factors, want & ZD_C ? out->C + at : NULL);        /* (5) */
            if (wants_Phi) out->Phi[i] = row->law < 0 ? sum + all.value : all.value;                                    /* (3) */
        }
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - zd_row_biases(self, readings, row, all.factors);                   /* (6) */
    }
    return ZD_DONE;
}
