/* With u and w the ways from the mass centres of both bodies to their points, d = x2 + w - x1 - u, and e the line's direction, a marker
 * quantity has
 *
 *     a value e . d,      the row [-e  -(u + d) x e | e  w x e],      and for (6)  e . dddot + 2 edot . ddot + eddot . d
 *
 * where e turns with the first body; u in the place of u + d where it does not, and of a distance |d| with e = d / |d|. An orbit has e
 * perpendicular to d, u + d, and no value. What is read off the
 * second body alone does nothing to the first. Angles are constant rows. See marker_quantity.c for the same in any tree. */
#include "packing.h"

static int turns_along(int kind) { return kind == ZD_PLANE_ALONG || kind == ZD_PLANE_ACROSS; }
static int is_at_second(int kind) { return turns_along(kind) || kind == ZD_PLANE_ORBIT; }
static int is_of_second_alone(int kind) { return kind == ZD_PLANE_GLIDE || kind == ZD_PLANE_SKID; }

static int has_angle(const zd_plane *mechanism, int body) { return mechanism->tree.link[body].hang == ZD_HANGS_FREE; }

zd_line zd_line_of(const zd_plane *mechanism, int row, int term, int C, int near, int far)
{
    const zd_plane_quantity *quantity = mechanism->quantity + mechanism->elements.term[term].quantity;
    const zd_vector axis = {quantity->axis[0], quantity->axis[1]};
    const int is_normal = quantity->kind == ZD_PLANE_ACROSS || quantity->kind == ZD_PLANE_SKID,
        has_near = near >= 0 && !is_of_second_alone(quantity->kind);
    return (zd_line){
        quantity->kind, row, term == mechanism->elements.row[row].first, quantity->first, quantity->second, has_near ? C + near : -1,
            far >= 0 ? C + far : -1,
        has_angle(mechanism, quantity->first), has_angle(mechanism, quantity->second), {quantity->point1[0], quantity->point1[1]},
        {quantity->point2[0], quantity->point2[1]}, is_normal ? zd_turned(1, axis) : axis, quantity->zero,
        mechanism->elements.coefficient[term]};
}

/* ---- what is known from positions ---- */

typedef struct sight {      /* from mass centre to point, of both bodies, and from point to point */
    zd_vector u, w, apart;
} sight;

ZD_INLINE sight sight_of(const zd_line *line, const zd_plane_frame *frame, const double *p)
{
    const zd_vector a = frame->axis[line->first], b = frame->axis[line->second];
    const double *x1 = zd_of_body(p, line->first), *x2 = zd_of_body(p, line->second);
    const zd_vector u = zd_rotated(a.x, a.y, line->point1), w = zd_rotated(b.x, b.y, line->point2);
    return (sight){u, w, {x2[0] + w.x - (x1[0] + u.x), x2[1] + w.y - (x1[1] + u.y)}};
}

static zd_vector direction_of(const zd_line *line, zd_vector axis, zd_vector apart, double length)
{
    switch (line->kind) {
    case ZD_PLANE_X: return (zd_vector){1, 0};
    case ZD_PLANE_Y: return (zd_vector){0, 1};
    case ZD_PLANE_DISTANCE: return zd_times(1 / length, apart);
    case ZD_PLANE_ORBIT: return zd_turned(-1 / sqrt(zd_inner(apart, apart)), apart);
    default: return zd_rotated(axis.x, axis.y, line->axis);
    }
}

/* The line's share of its row, and in `value` of Phi. */
static zd_plane_pull pull_of(const zd_line *line, const zd_plane_frame *frame, const double *p, double *value)
{
    const double c = line->coefficient;
    if (line->kind == ZD_PLANE_ANGLE) {
        *value = c * (zd_of_body(p, line->second)[2] - zd_of_body(p, line->first)[2] - line->zero);
        return (zd_plane_pull){{0, 0}, -c, c};
    }
    const sight at = sight_of(line, frame, p);
    const double length = line->kind == ZD_PLANE_DISTANCE ? sqrt(zd_inner(at.apart, at.apart)) : 0;
    const zd_vector e = zd_times(c, direction_of(line, frame->axis[line->first], at.apart, length));
    const zd_vector on_first = is_at_second(line->kind) ? zd_plus(at.u, at.apart) : at.u;
    *value = (line->kind == ZD_PLANE_DISTANCE ? c * length : zd_inner(e, at.apart)) - c * line->zero;       /* (3) */
    return (zd_plane_pull){e, -zd_cross(on_first, e), zd_cross(at.w, e)};                                          /* (5) */
}

static void write_pulls(const zd_lines *self, const zd_plane_frame *frame, int want, int mh, const double *p, double *Phi)
{
    for (int k = 0; k < self->count; k++) {
        const zd_line *line = self->line + k;
        double value;
        const zd_plane_pull pull = pull_of(line, frame, p, &value);
        if (want & ZD_MOVED) frame->pull[k] = pull;
        if (want & ZD_PHI && line->row < mh) Phi[line->row] += value;
    }
}

static void write_C(const zd_lines *self, const zd_plane_frame *frame, double *C)
{
    for (int k = 0; k < self->count; k++) {
        const zd_line *line = self->line + k;
        const zd_plane_pull pull = frame->pull[k];
        if (line->near >= 0) {
            double *x = C + line->near;
            x[0] -= pull.along.x, x[1] -= pull.along.y;
            if (line->near_turns) x[2] += pull.near;
        }
        if (line->far >= 0) {
            double *x = C + line->far;
            x[0] += pull.along.x, x[1] += pull.along.y;
            if (line->far_turns) x[2] += pull.far;
        }
    }
}

/* ---- and from velocities ---- */

static double bias_of(const zd_line *line, const zd_plane_frame *frame, zd_vector e, const double *p, const double *v)
{
    const double *v1 = zd_of_body(v, line->first), *v2 = zd_of_body(v, line->second), turn1 = v1[2], turn2 = v2[2];
    const sight at = sight_of(line, frame, p);
    zd_vector speed = zd_plus((zd_vector){v2[0], v2[1]}, zd_turned(turn2, at.w)), change = zd_times(-turn2 * turn2, at.w);
    const zd_vector edot = zd_turned(turn1, e);
    if (is_of_second_alone(line->kind)) return zd_inner(e, change) + zd_inner(edot, speed);
    if (line->kind == ZD_PLANE_ORBIT) {
        const zd_vector from = zd_minus(speed, (zd_vector){v1[0], v1[1]});
        const zd_vector relative = zd_minus(from, zd_turned(turn1, zd_plus(at.u, at.apart)));
        return zd_inner(e, zd_minus(change, zd_turned(turn1, from))) -
               zd_inner(e, zd_minus(from, zd_turned(turn1, at.u))) * zd_inner(at.apart, relative) / zd_inner(at.apart, at.apart);
    }
    speed = zd_minus(speed, zd_plus((zd_vector){v1[0], v1[1]}, zd_turned(turn1, at.u)));
    change = zd_plus(change, zd_times(turn1 * turn1, at.u));
    const double bias = zd_inner(e, change);
    if (turns_along(line->kind)) return bias + 2 * zd_inner(edot, speed) - turn1 * turn1 * zd_inner(e, at.apart);
    if (line->kind != ZD_PLANE_DISTANCE) return bias;
    const double square = zd_inner(at.apart, at.apart), across = zd_cross(at.apart, speed);
    return bias + line->coefficient * across * across / (square * sqrt(square));
}

static void write_xi(const zd_lines *self, const zd_plane_frame *frame, const double *p, const double *v, double *xi)
{
    for (int k = 0; k < self->count; k++) {
        const zd_line *line = self->line + k;
        if (line->kind != ZD_PLANE_ANGLE) xi[line->row] -= bias_of(line, frame, frame->pull[k].along, p, v);    /* (6) */
    }
}

/* Initializes the constant and explicit parts of rows; the marker quantities are added to them. */
static void begin_rows(const zd_lines *self, const zd_planned_elements *elements, int want, double t, const zd_terms *out)
{
    for (const zd_line *line = self->line; line < self->line + self->count; line++) {
        const zd_relation *row = elements->row + line->row;
        const double target = row->constant + row->slope * t;
        if (!line->is_first) continue;
        if (want & ZD_PHI && !row->nonholonomic) out->Phi[line->row] = -target;
        if (want & ZD_PHI_T) out->Phi_t[line->row] = row->nonholonomic ? -target : -row->slope;
        if (want & ZD_XI) out->xi[line->row] = row->nonholonomic ? row->slope : 0;
    }
}

void zd_lines_write(const zd_lines *self, const zd_revolute_joints *revolutes, const zd_plane *mechanism, const zd_plane_frame *frame,
                    int want, double t,
                    const double *p, const double *v, const zd_terms *out)
{
    if (!self->count) return;
    const zd_plane_tree *tree = &mechanism->tree;
    if (want & (ZD_PHI | ZD_PHI_T | ZD_XI)) begin_rows(self, &mechanism->elements, want, t, out);
    const double *place = want & (ZD_MOVED | ZD_PHI | ZD_XI) ? zd_revolute_joints_expand(revolutes, tree, p, frame->place) : NULL;
    if (want & (ZD_MOVED | ZD_PHI)) write_pulls(self, frame, want, mechanism->elements.mh, place, out->Phi);
    if (want & ZD_C) write_C(self, frame, out->C);
    if (want & ZD_XI) write_xi(self, frame, place, zd_revolute_joints_expand(revolutes, tree, v, frame->spread), out->xi);
}
