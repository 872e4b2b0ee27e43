/* The front builds the tables, and names bodies and joints to its user; here it is only made sure that nothing is looked up that is not there. */
#include "check.h"

#include <stdarg.h>
#include <stddef.h>
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

static int body_is_right(const zd_space_tables *tables, int i, complaint to)
{
    const zd_space_body *body = tables->body + i;
    const double *I = body->inertia;
    if (!(body->mass >= 0)) return wrong(to, "body %d: its mass must not be negative, and is %g", i + 1, body->mass);
    for (int k = 0; k < 3; k++) {
        if (!(I[k] >= 0)) return wrong(to, "body %d: its inertia must not be negative, and is %g", i + 1, I[k]);
        if (body->is_particle && I[k] > 0) return wrong(to, "body %d: a particle has no inertia", i + 1);
    }
    return 1;
}

static int are_bodies(const zd_space_tables *tables, int first, int second)
{
    return is_in(first, tables->bodies + 1) && is_in(second, tables->bodies + 1);
}

/* A particle has no axes: its point is its place. */
static int suits_particle(const zd_space_tables *tables, int body, const double *point)
{
    return !(body && tables->body[body - 1].is_particle) || (point[0] == 0 && point[1] == 0 && point[2] == 0);
}

static int joint_is_right(const zd_space_tables *tables, int i, complaint to)
{
    const zd_space_joint *joint = tables->joint + i;
    if (!zd_space_joint_kind_of(joint->kind)) return wrong(to, "joint %d: there is no kind %d", i, joint->kind);
    if (!are_bodies(tables, joint->first, joint->second))
        return wrong(to, "joint %d: it joins bodies %d and %d, and the last one is %d", i, joint->first, joint->second, tables->bodies);
    if (joint->first == joint->second) return wrong(to, "joint %d: it joins body %d to itself", i, joint->first);
    return (suits_particle(tables, joint->first, joint->point1) && suits_particle(tables, joint->second, joint->point2)) ||
           wrong(to, "joint %d: a particle has no points but its own", i);
}

static int gauge_is_right(const zd_space_tables *tables, int i, complaint to)
{
    const zd_space_gauge *gauge = tables->gauge + i;
    if (!is_in(gauge->kind, ZD_SPACE_GAUGES)) return wrong(to, "gauge %d: there is no kind %d", i, gauge->kind);
    if (!are_bodies(tables, gauge->first, gauge->second))
        return wrong(to, "gauge %d: it is read off bodies %d and %d, and the last one is %d", i, gauge->first, gauge->second, tables->bodies);
    return (suits_particle(tables, gauge->first, gauge->point1) && suits_particle(tables, gauge->second, gauge->point2)) ||
           wrong(to, "gauge %d: a particle has no points but its own", i);
}

static int terms_are_right(const zd_space_tables *tables, int first, int terms, int law, int joint)
{
    if (first < 0 || terms < 0 || first + terms > tables->terms || law < -1 || (law >= 0 && !tables->law)) return 0;
    for (int i = first; i < first + terms; i++)
        if (!is_in(tables->term[i].gauge, tables->gauges)) return 0;
    return joint == -1 || is_in(joint, tables->joints);
}

static int relation_is_right(const zd_space_tables *tables, int i, complaint to)
{
    const zd_relation *row = tables->relation + i;
    return (row->terms > 0 && terms_are_right(tables, row->first, row->terms, row->law, row->joint)) ||
           wrong(to, "relation %d: its gauges, law or joint are not there", i);
}

static int effort_is_right(const zd_space_tables *tables, int i, complaint to)
{
    const zd_effort *effort = tables->effort + i;
    const int needs_law = effort->kind == ZD_EFFORT_LAW;
    return (is_in(effort->kind, ZD_EFFORT_LAW + 1) && is_in(effort->gauge, tables->gauges) && needs_law == (effort->law >= 0) &&
            terms_are_right(tables, effort->first, effort->terms, effort->law, effort->joint)) ||
           wrong(to, "effort %d: its kind, gauges, law or joint are not there", i);
}

static int measure_is_right(const zd_space_tables *tables, int i, complaint to)
{
    const zd_observed *measure = tables->measure + i;
    const int quantity = measure->quantity;
    int size = 1, count = 0;
    if (quantity >= ZD_VALUES && quantity <= ZD_ACCELERATIONS) count = tables->gauges, size = measure->size;
    else if (quantity >= ZD_JOINT_FORCE && quantity <= ZD_JOINT_TENSION) count = tables->joints;
    else if (quantity == ZD_EFFORT_VALUE || quantity == ZD_EFFORT_POWER) count = tables->efforts;
    else if (quantity == ZD_DRIVE_VALUE || quantity == ZD_DRIVE_POWER) count = tables->relations;
    const int terms = quantity == ZD_DRIVE_VALUE && is_in(measure->index, count) ? tables->relation[measure->index].terms : 1;
    return (size > 0 && is_in(measure->index, count) && measure->index + size <= count && is_in(measure->term, terms)) ||
           wrong(to, "measure %s: what it is of is not there", measure->name);
}

int zd_space_tables_are_right(const zd_space_tables *tables, char *message, int message_size)
{
    const complaint to = {message, message_size};
    const struct {
        int count;
        int (*is_right)(const zd_space_tables *, int, complaint);
    } all[] = {
        {tables->bodies, body_is_right},        {tables->joints, joint_is_right},   {tables->gauges, gauge_is_right},
        {tables->relations, relation_is_right}, {tables->efforts, effort_is_right}, {tables->measures, measure_is_right},
    };
    if (tables->bodies < 1) return wrong(to, "a mechanism needs at least one body");
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        for (int i = 0; i < all[k].count; i++)
            if (!all[k].is_right(tables, i, to)) return 0;
    return 1;
}
