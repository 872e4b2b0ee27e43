/* Bodies, joints and gauges of the plane; what gauges are used for is looked at elsewhere. */
#include "check.h"

#include <stddef.h>

#include "../common/check.h"

static int is_body(const zd_plane_tables *tables, int body) { return zd_is_in(body, tables->bodies + 1); }
static int is_particle(const zd_plane_tables *tables, int body) { return body && tables->body[body - 1].is_particle; }

static int carrier_is_right(const zd_plane_tables *tables, int i, zd_complaint to)
{
    int carrier = tables->body[i].carrier, body = i + 1;
    if (carrier == -1) return 1;
    if (!zd_is_in(carrier, tables->joints)) return zd_complain(to, "body %d: there is no joint %d to carry it", body, carrier);
    const zd_plane_joint *joint = tables->joint + carrier;
    const zd_plane_joint_kind *kind = zd_plane_joint_kind_of(joint->kind);
    int touches = body == joint->first || body == joint->second;
    if (!touches) return zd_complain(to, "body %d: joint %d, which is to carry it, does not touch it", body, carrier);
    if (kind->carrier == ZD_CARRIES_NOTHING) return zd_complain(to, "body %d: joint %d is a %s and carries nothing", body, carrier,
                                                                kind->card.name);
    if (kind->carrier != ZD_TURNS && (is_particle(tables, joint->first) || is_particle(tables, joint->second)))
        return zd_complain(to, "body %d: joint %d is a %s, and a particle has no angle", body, carrier, kind->card.name);
    for (int other = 0; other < i; other++)
        if (tables->body[other].carrier == carrier) return zd_complain(to, "joint %d carries both body %d and body %d", carrier, other + 1,
                                                                       body);
    return 1;
}

static int body_is_right(const zd_plane_tables *tables, int i, zd_complaint to)
{
    const zd_plane_body *body = tables->body + i;
    if (!(body->mass >= 0)) return zd_complain(to, "body %d: its mass must not be negative, and is %g", i + 1, body->mass);
    if (!(body->inertia >= 0)) return zd_complain(to, "body %d: its inertia must not be negative, and is %g", i + 1, body->inertia);
    if (body->is_particle && body->inertia > 0) return zd_complain(to, "body %d: a particle has no inertia", i + 1);
    return carrier_is_right(tables, i, to);
}

/* A particle has no axes: its point is its place. */
static int suits_particles(const zd_plane_tables *tables, int first, int second, const double *point1, const double *point2)
{
    return !(is_particle(tables, first) && (point1[0] != 0 || point1[1] != 0)) &&
           !(is_particle(tables, second) && (point2[0] != 0 || point2[1] != 0));
}

static int joint_is_right(const zd_plane_tables *tables, int i, zd_complaint to)
{
    const zd_plane_joint *joint = tables->joint + i;
    const zd_plane_joint_kind *kind = zd_plane_joint_kind_of(joint->kind);
    if (!kind) return zd_complain(to, "joint %d: there is no kind %d", i, joint->kind);
    if (!is_body(tables, joint->first) || !is_body(tables, joint->second))
        return zd_complain(to, "joint %d: it joins bodies %d and %d, and the last one is %d", i, joint->first, joint->second, tables->bodies);
    if (joint->first == joint->second && !kind->row[0].nonholonomic) return zd_complain(to, "joint %d: it joins body %d to itself", i,
                                                                                        joint->first);
    if (!suits_particles(tables, joint->first, joint->second, joint->point1, joint->point2))
        return zd_complain(to, "joint %d: a particle has no points but its own", i);
    return 1;
}

static int gauge_is_right(const zd_plane_tables *tables, int i, zd_complaint to)
{
    const zd_plane_gauge *gauge = tables->gauge + i;
    if (!zd_is_in(gauge->kind, ZD_GAUGE_KINDS)) return zd_complain(to, "gauge %d: there is no kind %d", i, gauge->kind);
    if (!is_body(tables, gauge->first) || !is_body(tables, gauge->second))
        return zd_complain(to, "gauge %d: it is read off bodies %d and %d, and the last one is %d", i, gauge->first, gauge->second,
                           tables->bodies);
    if (!suits_particles(tables, gauge->first, gauge->second, gauge->point1, gauge->point2))
        return zd_complain(to, "gauge %d: a particle has no points but its own", i);
    return 1;
}

int zd_plane_tables_are_right(const zd_plane_tables *tables, char *message, int message_size)
{
    zd_complaint to = {message, message_size};
    const struct {
        int count;
        int (*is_right)(const zd_plane_tables *, int, zd_complaint);
    } all[] = {     /* joints before the bodies that they carry */
        {tables->joints, joint_is_right}, {tables->bodies, body_is_right}, {tables->gauges, gauge_is_right},
    };
    if (tables->bodies < 1) return zd_complain(to, "a mechanism needs at least one body");
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        for (int i = 0; i < all[k].count; i++)
            if (!all[k].is_right(tables, i, to)) return 0;
    return zd_elements_are_right(&tables->elements, tables->joints, tables->gauges, to);
}
