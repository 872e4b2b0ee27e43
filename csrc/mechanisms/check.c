/* The front builds the tables, and names bodies and joints to its user; here it is only made sure that nothing is looked up that is not there. */
#include "check.h"

#include <stdarg.h>
#include <stdio.h>

typedef struct complaint {
    char *message;
    int size;
} complaint;

/* Writes what is wrong; returns that it is. */
static int wrong(complaint to, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(to.message, (size_t)to.size, format, list);
    va_end(list);
    return 0;
}

static int is_in(int index, int count) { return index >= 0 && index < count; }
static int is_body(const zd_tables *tables, int body) { return is_in(body, tables->bodies + 1); }
static int is_particle(const zd_tables *tables, int body) { return body && tables->body[body - 1].is_particle; }

static int carrier_is_right(const zd_tables *tables, int i, complaint to)
{
    int carrier = tables->body[i].carrier, body = i + 1;
    if (carrier == -1) return 1;
    if (!is_in(carrier, tables->joints)) return wrong(to, "body %d: there is no joint %d to carry it", body, carrier);
    const zd_joint *joint = tables->joint + carrier;
    const zd_joint_kind *kind = zd_joint_kind_of(joint->kind);
    int touches = body == joint->first || body == joint->second;
    if (!touches) return wrong(to, "body %d: joint %d, which is to carry it, does not touch it", body, carrier);
    if (kind->carrier == ZD_CARRIES_NOTHING) return wrong(to, "body %d: joint %d is a %s and carries nothing", body, carrier, kind->card.name);
    if (kind->carrier != ZD_TURNS && (is_particle(tables, joint->first) || is_particle(tables, joint->second)))
        return wrong(to, "body %d: joint %d is a %s, and a particle has no angle", body, carrier, kind->card.name);
    for (int other = 0; other < i; other++)
        if (tables->body[other].carrier == carrier) return wrong(to, "joint %d carries both body %d and body %d", carrier, other + 1, body);
    return 1;
}

static int body_is_right(const zd_tables *tables, int i, complaint to)
{
    const zd_body *body = tables->body + i;
    if (!(body->mass >= 0)) return wrong(to, "body %d: its mass must not be negative, and is %g", i + 1, body->mass);
    if (!(body->inertia >= 0)) return wrong(to, "body %d: its inertia must not be negative, and is %g", i + 1, body->inertia);
    if (body->is_particle && body->inertia > 0) return wrong(to, "body %d: a particle has no inertia", i + 1);
    return carrier_is_right(tables, i, to);
}

/* A particle has no axes: its point is its place. */
static int suits_particles(const zd_tables *tables, int first, int second, const double *point1, const double *point2)
{
    return !(is_particle(tables, first) && (point1[0] != 0 || point1[1] != 0)) &&
           !(is_particle(tables, second) && (point2[0] != 0 || point2[1] != 0));
}

static int joint_is_right(const zd_tables *tables, int i, complaint to)
{
    const zd_joint *joint = tables->joint + i;
    const zd_joint_kind *kind = zd_joint_kind_of(joint->kind);
    if (!kind) return wrong(to, "joint %d: there is no kind %d", i, joint->kind);
    if (!is_body(tables, joint->first) || !is_body(tables, joint->second))
        return wrong(to, "joint %d: it joins bodies %d and %d, and the last one is %d", i, joint->first, joint->second, tables->bodies);
    if (joint->first == joint->second && !kind->row[0].nonholonomic) return wrong(to, "joint %d: it joins body %d to itself", i, joint->first);
    if (!suits_particles(tables, joint->first, joint->second, joint->point1, joint->point2))
        return wrong(to, "joint %d: a particle has no points but its own", i);
    return 1;
}

static int gauge_is_right(const zd_tables *tables, int i, complaint to)
{
    const zd_gauge *gauge = tables->gauge + i;
    if (!is_in(gauge->kind, ZD_GAUGE_KINDS)) return wrong(to, "gauge %d: there is no kind %d", i, gauge->kind);
    if (!is_body(tables, gauge->first) || !is_body(tables, gauge->second))
        return wrong(to, "gauge %d: it is read off bodies %d and %d, and the last one is %d", i, gauge->first, gauge->second, tables->bodies);
    if (!suits_particles(tables, gauge->first, gauge->second, gauge->point1, gauge->point2))
        return wrong(to, "gauge %d: a particle has no points but its own", i);
    return 1;
}

static int terms_are_right(const zd_tables *tables, int first, int terms, int law, int joint)
{
    if (first < 0 || terms < 0 || first + terms > tables->terms || law < -1 || (law >= 0 && !tables->law)) return 0;
    for (int i = first; i < first + terms; i++)
        if (!is_in(tables->term[i].gauge, tables->gauges)) return 0;
    return joint == -1 || is_in(joint, tables->joints);
}

static int relation_is_right(const zd_tables *tables, int i, complaint to)
{
    const zd_relation *row = tables->relation + i;
    return (row->terms > 0 && terms_are_right(tables, row->first, row->terms, row->law, row->joint)) ||
           wrong(to, "relation %d: its gauges, law or joint are not there", i);
}

static int effort_is_right(const zd_tables *tables, int i, complaint to)
{
    const zd_effort *effort = tables->effort + i;
    int needs_law = effort->kind == ZD_EFFORT_LAW;
    return (is_in(effort->kind, ZD_EFFORT_LAW + 1) && is_in(effort->gauge, tables->gauges) && needs_law == (effort->law >= 0) &&
            terms_are_right(tables, effort->first, effort->terms, effort->law, effort->joint)) ||
           wrong(to, "effort %d: its kind, gauges, law or joint are not there", i);
}

static int measure_is_right(const zd_tables *tables, int i, complaint to)
{
    const zd_observed *measure = tables->measure + i;
    int quantity = measure->quantity, size = 1, count = 0;
    if (quantity >= ZD_VALUES && quantity <= ZD_ACCELERATIONS) count = tables->gauges, size = measure->size;
    else if (quantity >= ZD_JOINT_FORCE && quantity <= ZD_JOINT_TENSION) count = tables->joints;
    else if (quantity == ZD_EFFORT_VALUE || quantity == ZD_EFFORT_POWER) count = tables->efforts;
    else if (quantity == ZD_EFFORT_FORCE) count = tables->efforts, size = measure->size;
    else if (quantity == ZD_DRIVE_VALUE || quantity == ZD_DRIVE_POWER) count = tables->relations;
    int terms = quantity == ZD_DRIVE_VALUE && is_in(measure->index, count) ? tables->relation[measure->index].terms : 1;
    return (size > 0 && is_in(measure->index, count) && measure->index + size <= count && is_in(measure->term, terms)) ||
           wrong(to, "measure %s: what it is of is not there", measure->name);
}

int zd_tables_are_right(const zd_tables *tables, char *message, int message_size)
{
    complaint to = {message, message_size};
    const struct {
        int count;
        int (*is_right)(const zd_tables *, int, complaint);
    } all[] = {     /* joints before the bodies that they carry */
        {tables->joints, joint_is_right},       {tables->bodies, body_is_right},     {tables->gauges, gauge_is_right},
        {tables->relations, relation_is_right}, {tables->efforts, effort_is_right},  {tables->measures, measure_is_right},
    };
    if (tables->bodies < 1) return wrong(to, "a mechanism needs at least one body");
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        for (int i = 0; i < all[k].count; i++)
            if (!all[k].is_right(tables, i, to)) return 0;
    return 1;
}
