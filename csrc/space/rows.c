/* A row is a combination of gauges, as in the plane: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
#include "rows.h"

#include "../gauges/laws.h"
#include "gauge.h"

static const zd_space_gauge *gauge_of(const zd_space *self, const zd_relation *row, int i)
{
    return self->gauge + self->uses.term[row->first + i].gauge;
}

static void add_to_row(const zd_space *self, const zd_frame3 *frame, int term, double scale, const zd_reading3 *reading, double *to)
{
    const zd_space_gauge *gauge = self->gauge + self->uses.term[term].gauge;
    const int first = gauge->first, second = gauge->second;
    if (first) zd_body_act(self->body + first, frame->pose + first, scale, reading->first, to + self->packed.near[term]);
    if (second) zd_body_act(self->body + second, frame->pose + second, scale, reading->second, to + self->packed.far[term]);
}

/* Returns the sum of factors x, and adds that of factors times the gauges' rows to `to` unless that is NULL. */
static double add_readings(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, const double *factors, double *to)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) {
        const zd_reading3 reading = zd_space_gauge_read(gauge_of(self, row, i), frame->pose);
        sum += factors[i] * reading.value;
        if (to) add_to_row(self, frame, row->first + i, factors[i], &reading, to);
    }
    return sum;
}

static double sum_of_biases(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, const double *factors)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) sum += factors[i] * zd_space_gauge_bias(gauge_of(self, row, i), frame->pose, frame->twist);
    return sum;
}

/* The value of a row, less what makes no difference to it. */
static double modulo(double value, double period) { return period > 0 ? remainder(value, period) : value; }

/* ---- a point on a point: three rows that share all but the axis ---- */

/* Whether rows i, i + 1 and i + 2 are x, y and z of one joint's points, and nothing else. */
static int is_point(const zd_space *self, int i)
{
    const zd_row_owner *owner = self->uses.owner_of_row + i;
    return owner->owner == ZD_OF_JOINT && gauge_of(self, self->uses.row + i, 0)->kind == ZD_SPACE_X;
}

/* sign times the rows of a body's point, (3, 6) or (3, 3) of rows `width` apart. */
static void write_side(const zd_body3 *body, const zd_pose3 *pose, const double *point, double sign, int width, double *C)
{
    const zd_rotation *R = &pose->turned;
    const zd_vector3 axis[] = {{R->x.x, R->y.x, R->z.x}, {R->x.y, R->y.y, R->z.y}, {R->x.z, R->y.z, R->z.z}};   /* in the body's */
    for (int k = 0; k < 3; k++, C += width) {
        C[k] = sign;
        if (!body->turns) continue;
        const zd_vector3 torque = zd_cross3(zd_vector3_of(point), axis[k]);
        C[3] = sign * torque.x, C[4] = sign * torque.y, C[5] = sign * torque.z;
    }
}

static zd_vector3 bias_of_point(const zd_pose3 *pose, const zd_twist3 *twist, const double *point)
{
    return zd_cross3(twist->spin, zd_cross3(twist->spin, zd_rotated3(&pose->turned, zd_vector3_of(point))));
}

static void write_point(const zd_space *self, const zd_frame3 *frame, int want, int i, const zd_terms *out)
{
    const zd_space_gauge *gauge = gauge_of(self, self->uses.row + i, 0);
    const int first = gauge->first, second = gauge->second, term = self->uses.row[i].first;
    const zd_pose3 *near = frame->pose + first, *far = frame->pose + second;
    if (want & ZD_PHI) {
        const zd_vector3 apart = zd_minus3(zd_point3_of(far, gauge->point2), zd_point3_of(near, gauge->point1));
        out->Phi[i] = apart.x, out->Phi[i + 1] = apart.y, out->Phi[i + 2] = apart.z;        /* (3) */
    }
    if (want & ZD_C) {
        const int width = self->packed.at[i + 1] - self->packed.at[i];
        double *C = out->C + self->packed.at[i];
        if (first) write_side(self->body + first, near, gauge->point1, -1, width, C + self->packed.near[term]);
        if (second) write_side(self->body + second, far, gauge->point2, 1, width, C + self->packed.far[term]);
    }
    if (want & ZD_PHI_T) out->Phi_t[i] = out->Phi_t[i + 1] = out->Phi_t[i + 2] = 0;
    if (want & ZD_XI) {
        const zd_vector3 bias = zd_minus3(bias_of_point(far, frame->twist + second, gauge->point2),
                                          bias_of_point(near, frame->twist + first, gauge->point1));
        out->xi[i] = -bias.x, out->xi[i + 1] = -bias.y, out->xi[i + 2] = -bias.z;           /* (6) */
    }
}

int zd_space_rows_write(const zd_space *self, const zd_frame3 *frame, int want, double t, const zd_terms *out)
{
    const zd_readings readings = zd_frame3_readings(self, frame);
    for (int i = 0; i < self->uses.m; i++) {
        if (is_point(self, i)) {
            write_point(self, frame, want, i, out);
            i += 2;
            continue;
        }
        const zd_relation *row = self->uses.row + i;
        zd_combined all;
        const int status = zd_combine(&self->uses, &readings, row, t, &all), wants_Phi = (want & ZD_PHI) && i < self->uses.mh;
        if (status) return status;
        if (wants_Phi || want & ZD_C) {
            const double sum = add_readings(self, frame, row, all.factors, want & ZD_C ? out->C + self->packed.at[i] : NULL);      /* (5) */
            if (wants_Phi) out->Phi[i] = modulo(row->law < 0 ? sum + all.value : all.value, self->period[i]);               /* (3) */
        }
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - sum_of_biases(self, frame, row, all.factors);                          /* (6) */
    }
    return ZD_DONE;
}
