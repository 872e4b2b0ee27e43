/* Python builds the tables, and reports errors by the names of bodies and joints; these checks only ensure that every index is in range. */
#include "check.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

int zd_complain(zd_complaint to, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(to.message, to.size, format, list);
    va_end(list);
    return 0;
}

void zd_append(zd_complaint *to, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int size = vsnprintf(to->message, to->size, format, list), used = size < to->size ? size : to->size - 1;
    va_end(list);
    to->message += used;
    to->size -= used;
}

/* Elements with the numbers of joints and marker quantities that they may refer to. */
typedef struct tables {
    const zd_elements *elements;
    int joints, quantities;
} tables;

static int terms_are_right(const tables *of, int first, int terms, int law, int joint)
{
    const zd_elements *elements = of->elements;
    if (first < 0 || terms < 0 || first + terms > elements->terms || law < -1 || (law >= 0 && !elements->law)) return 0;
    for (int i = first; i < first + terms; i++)
        if (!zd_is_in(elements->term[i].quantity, of->quantities)) return 0;
    return joint == -1 || zd_is_in(joint, of->joints);
}

static int relation_is_right(const tables *of, int i, zd_complaint to)
{
    const zd_relation *row = of->elements->relation + i;
    return (row->terms > 0 && terms_are_right(of, row->first, row->terms, row->law, row->joint)) ||
           zd_complain(to, "relation %d: its marker quantities, user function and joint must exist", i);
}

static int force_is_right(const tables *of, int i, zd_complaint to)
{
    const zd_generalized_force *force = of->elements->force + i;
    const int needs_law = force->kind == ZD_FORCE_LAW;
    if (force->kind == ZD_FORCE_SEPARATION && (!zd_is_in(force->first, of->elements->relations) || force->terms))
        return zd_complain(to, "separating force %d: its relation must exist", i);
    return (zd_is_in(force->kind, ZD_FORCE_SEPARATION + 1) && zd_is_in(force->quantity, of->quantities) && needs_law == (force->law >= 0) &&
            terms_are_right(of, force->first, force->terms, force->law, force->joint)) ||
           zd_complain(to, "generalized force %d: its kind, marker quantities, user function and joint must exist", i);
}

/* Number of entries that the index of a measure of this kind selects from. */
static int count_of(const tables *of, int kind)
{
    switch (kind) {
    case ZD_VALUES:
    case ZD_RATES:
    case ZD_ACCELERATIONS: return of->quantities;
    case ZD_JOINT_FORCE:
    case ZD_JOINT_TORQUE:
    case ZD_JOINT_TENSION: return of->joints;
    case ZD_FORCE_VALUE:
    case ZD_FORCE_POWER:
    case ZD_FORCE_SUM:
    case ZD_TORQUE_SUM: return of->elements->forces;
    case ZD_DRIVE_VALUE:
    case ZD_DRIVE_POWER: return of->elements->relations;
    default: return 0;
    }
}

static int formula_is_right(const zd_elements *elements, const zd_output_spec *formula)
{
    const int first = formula->term, count = formula->size;
    if (!elements->law || formula->index < 0 || first < 0 || !zd_is_in(count, ZD_MAX_READS + 1) || first + count > elements->terms) return 0;
    for (const zd_quantity_term *term = elements->term + first; term < elements->term + first + count; term++) {
        const int has_component = term->coefficient >= 0 && term->coefficient < (double)ZD_MAX_COMPONENTS;
        if (!zd_is_in(term->quantity, elements->measures) || !has_component) return 0;
        const zd_output_spec *measure = elements->measure + term->quantity;
        if (measure->kind == ZD_FORMULA || measure->size > ZD_MAX_COMPONENTS) return 0;
    }
    return 1;
}

static int sum_is_right(const tables *of, const zd_output_spec *sum)
{
    const int first = sum->term, count = sum->size;
    if (sum->kind > ZD_INERTIA_TORQUE || first < 0 || count < 1 || first + count > of->elements->terms || sum->index < 1) return 0;
    for (const zd_quantity_term *term = of->elements->term + first; term < of->elements->term + first + count; term++)
        if (term->quantity != -1 && !zd_is_in(term->quantity, of->quantities)) return 0;
    return 1;
}

static int measure_is_right(const tables *of, int i, zd_complaint to)
{
    const zd_output_spec *measure = of->elements->measure + i;
    if (measure->kind == ZD_FORMULA)
        return formula_is_right(of->elements, measure) || zd_complain(to, "measure %s must read quantities that exist", measure->name);
    if (measure->kind > ZD_FORMULA)
        return sum_is_right(of, measure) || zd_complain(to, "measure %s: the entries that it measures must exist", measure->name);
    const int kind = measure->kind, count = count_of(of, kind), index = measure->index;
    const int size = kind <= ZD_ACCELERATIONS || kind >= ZD_FORCE_SUM ? measure->size : 1;
    const int last = kind == ZD_DRIVE_VALUE && zd_is_in(index, count) ? of->elements->relation[index].terms
                   : kind == ZD_JOINT_FORCE                           ? count - 1 - index
                                                                      : kind == ZD_JOINT_TORQUE;
    return (size > 0 && zd_is_in(index, count) && index + size <= count && zd_is_in(measure->term, last + 1)) ||
           zd_complain(to, "measure %s: the entries that it measures must exist", measure->name);
}

static int group_is_right(const tables *of, int i, zd_complaint to)
{
    const zd_element_group *group = of->elements->group + i;
    const int owners = group->owner == ZD_OF_JOINT ? of->joints : of->elements->relations;
    return (zd_is_in(group->owner, ZD_OF_RELATION + 1) && zd_is_in(group->index, owners) && zd_is_in(group->kind, ZD_ONE_WAY + 1) &&
            zd_is_in(group->normal, of->elements->groups + 1) && (!group->loads || zd_is_in(group->load_joint, of->joints)) &&
            zd_is_in(group->range, of->elements->relations + 1) && zd_is_in(group->opposite, of->elements->groups + 1)) ||
           zd_complain(to, "group %s: its kind, joint, relation, load, range and other side must exist", group->name);
}

/* True if relations, generalized forces and measures refer to existing marker quantities and joints; otherwise writes which one does not. */
static int elements_are_right(const zd_elements *elements, int joints, int quantities, zd_complaint to)
{
    const tables of = {elements, joints, quantities};
    const struct {
        int count;
        int (*is_right)(const tables *, int, zd_complaint);
    } all[] = {{elements->relations, relation_is_right}, {elements->forces, force_is_right}, {elements->measures, measure_is_right},
               {elements->groups, group_is_right}};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        for (int i = 0; i < all[k].count; i++)
            if (!all[k].is_right(&of, i, to)) return 0;
    return 1;
}

int zd_mass_is_right(int body, double mass, zd_complaint to)
{
    return mass >= 0 || zd_complain(to, "body %d: its mass must be at least 0, not %g", body, mass);
}

int zd_inertia_is_right(int body, double inertia, int is_particle, zd_complaint to)
{
    if (!(inertia >= 0)) return zd_complain(to, "body %d: its inertia must be at least 0, not %g", body, inertia);
    return !is_particle || inertia == 0 || zd_complain(to, "body %d: the inertia of a particle must be 0", body);
}

int zd_bodies_are_right(const char *entry, int index, int first, int second, int bodies, zd_complaint to)
{
    return (zd_is_in(first, bodies + 1) && zd_is_in(second, bodies + 1)) ||
           zd_complain(to, "%s %d: its bodies must be from 0 to %d, not %d and %d", entry, index, bodies, first, second);
}

int zd_inboard_exists(int body, int inboard, int joints, zd_complaint to)
{
    return zd_is_in(inboard, joints) ||
           zd_complain(to, "body %d: its inboard joint must be at least -1 and below %d, not %d", body, joints, inboard);
}

int zd_inboard_connects(int body, int inboard, int first, int second, zd_complaint to)
{
    return body == first || body == second || zd_complain(to, "body %d: its inboard joint %d must connect it", body, inboard);
}

int zd_mechanism_is_right(const void *of, int bodies, int arrays, const zd_checked *checked, const zd_elements *elements, int joints,
                          int quantities, zd_complaint to)
{
    if (bodies < 1) return zd_complain(to, "a mechanism must have at least one body");
    for (int k = 0; k < arrays; k++)
        for (int i = 0; i < checked[k].count; i++)
            if (!checked[k].is_right(of, i, to)) return 0;
    return elements_are_right(elements, joints, quantities, to);
}
