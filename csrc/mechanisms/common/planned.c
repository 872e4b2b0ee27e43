/* From tables to rows: holonomic ones first, those of joints before those of relations. */
#include "planned.h"

#include "elements.h"

void zd_elements_create(zd_element_parts *to, zd_arena *arena, const zd_elements *elements, size_t terms, size_t rows)
{
    terms += elements->terms;
    rows += elements->relations;
#define TAKE(member, count) to->member = zd_arena_bytes(arena, (count) * sizeof *to->member)
    TAKE(term, terms);
    TAKE(coefficient, terms);
    TAKE(row, rows);
    TAKE(owner_of_constraint, rows);
    TAKE(constraint_of_relation, elements->relations);
    TAKE(force, elements->forces);
    TAKE(output, elements->measures);
    TAKE(measure, elements->measures);
    TAKE(group, elements->groups);
#undef TAKE
}

void zd_elements_copy(const zd_elements *elements, zd_element_parts *to)
{
    for (int i = 0; i < elements->forces; i++) to->force[i] = elements->force[i];
    for (int i = 0; i < elements->measures; i++) to->output[i] = elements->measure[i];
    for (int i = 0; i < elements->terms; i++) zd_elements_add_term(to, elements->term[i].quantity, elements->term[i].coefficient);
}

void zd_elements_add_term(zd_element_parts *to, int quantity, double coefficient)
{
    to->coefficient[to->terms] = coefficient;
    to->term[to->terms++] = (zd_quantity_term){quantity, coefficient};
}

static void add_row(zd_element_parts *to, zd_relation row, zd_constraint_owner owner)
{
    to->row[to->rows] = row;
    to->owner_of_constraint[to->rows++] = owner;
}

void zd_elements_add_joint_row(zd_element_parts *to, int first, int nonholonomic, int joint, int component)
{
    const zd_relation row = {first, to->terms - first, nonholonomic, -1, 0, 0, joint};
    add_row(to, row, (zd_constraint_owner){ZD_OF_JOINT, joint, component});
}

void zd_elements_add_relations(const zd_elements *elements, int nonholonomic, zd_element_parts *to)
{
    for (int i = 0; i < elements->relations; i++) {
        if (elements->relation[i].nonholonomic != nonholonomic) continue;
        to->constraint_of_relation[i] = to->rows;
        add_row(to, elements->relation[i], (zd_constraint_owner){ZD_OF_RELATION, i, 0});
    }
}

static int find_row(const zd_element_parts *from, int owner, int index, int component)
{
    int row = 0;
    for (; row < from->rows; row++) {
        const zd_constraint_owner *of = from->owner_of_constraint + row;
        if ((int)of->owner == owner && of->index == index && of->component == component) break;
    }
    return row;
}

void zd_elements_set_groups(const zd_elements *elements, const zd_element_parts *from, zd_system *system)
{
    for (int g = 0; g < elements->groups; g++) {
        const zd_element_group *of = elements->group + g;
        zd_group group = {.name = of->name, .first = find_row(from, of->owner, of->index, of->component), .rows = of->rows,
                          .kind = (enum zd_group_kind)of->kind, .sign = of->sign, .scale = of->scale,
                          .value = of->value, .is_active = of->is_active,
                          .normal = of->normal, .loads = of->loads, .at_ends = of->at_ends, .restitution = of->restitution,
                          .friction = {of->friction[0], of->friction[1]}};
        group.opposite = of->opposite, group.lower = of->lower, group.upper = of->upper;
        if (of->range) group.range = 1 + find_row(from, ZD_OF_RELATION, of->range - 1, 0);
        if (of->loads) group.load = find_row(from, ZD_OF_JOINT, of->load_joint, of->load_component);
        memcpy(group.load_factor, of->load_factor, sizeof group.load_factor);
        from->group[g] = group;
    }
    system->groups = elements->groups;
    system->group = from->group;
}

/* ---- what follows for the system ---- */

static int longest_of(const zd_elements *elements)
{
    int longest = 2;        /* the row of a joint that rolls or advances */
    for (int i = 0; i < elements->relations; i++)
        if (elements->relation[i].terms > longest) longest = elements->relation[i].terms;
    for (int i = 0; i < elements->forces; i++)
        if (elements->force[i].terms > longest) longest = elements->force[i].terms;
    for (int i = 0; i < elements->measures; i++)
        if (elements->measure[i].kind == ZD_FORMULA && elements->measure[i].size > longest) longest = elements->measure[i].size;
    return longest + (elements->reading ? elements->reading->count : 0);
}

static int forces_know_velocity(const zd_elements *elements)
{
    for (int i = 0; i < elements->forces; i++)
        if (elements->force[i].damping != 0 || elements->force[i].kind == ZD_FORCE_LAW) return 1;
    return 0;
}

static int forces_have_power(const zd_elements *elements)
{
    for (int i = 0; i < elements->forces; i++)
        if (elements->force[i].damping != 0 || elements->force[i].kind == ZD_FORCE_CONSTANT || elements->force[i].kind == ZD_FORCE_LAW)
            return 1;
    return 0;
}

/* True if the rate of a row has an explicit part, dg/dt or a_0 of (5). */
static int rows_have_explicit_rate(const zd_elements *elements)
{
    for (int i = 0; i < elements->relations; i++) {
        const zd_relation *row = elements->relation + i;
        if (row->slope != 0 || (row->nonholonomic && row->constant != 0)) return 1;
        if (row->law >= 0 && (row->nonholonomic || elements->laws_know_time)) return 1;
    }
    return 0;
}

static int knows_time(const zd_elements *elements)
{
    for (int i = 0; i < elements->relations; i++)
        if (elements->relation[i].slope != 0) return 1;
    return elements->law && elements->laws_know_time;
}

zd_planned_elements zd_elements_plan(const zd_elements *elements, const zd_element_parts *from, int mh)
{
    return (zd_planned_elements){
        .reading = elements->reading ? *elements->reading : (zd_reading){0},
        .relations = elements->relations, .forces = elements->forces, .mh = mh, .m = from->rows, .longest = longest_of(elements),
        .length = elements->length > 0 ? elements->length : 1, .term = from->term, .coefficient = from->coefficient, .row = from->row,
        .owner_of_constraint = from->owner_of_constraint, .constraint_of_relation = from->constraint_of_relation,
        .force = from->force, .output = from->output,
        .law = elements->law, .owner = elements->owner, .program = elements->program, .has_velocity_forces = forces_know_velocity(elements),
    };
}

int zd_elements_terms(const zd_elements *elements, const zd_planned_elements *planned)
{
    int terms = 0;
    if (planned->m) terms |= ZD_C | ZD_XI;
    if (planned->mh) terms |= ZD_PHI;
    if (rows_have_explicit_rate(elements)) terms |= ZD_PHI_T;
    if (forces_have_power(elements)) terms |= ZD_POWER;
    if (!knows_time(elements)) terms |= ZD_TIMELESS;
    return terms;
}
