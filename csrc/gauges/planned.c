/* From tables to rows: holonomic ones first, those of joints before those of relations. */
#include "planned.h"

void zd_uses_take(zd_use_parts *to, zd_arena *arena, const zd_uses *uses, size_t terms, size_t rows)
{
    terms += (size_t)uses->terms;
    rows += (size_t)uses->relations;
#define TAKE(member, count) to->member = zd_take(arena, (count) * sizeof *to->member)
    TAKE(term, terms);
    TAKE(coefficient, terms);
    TAKE(row, rows);
    TAKE(owner_of_row, rows);
    TAKE(row_of_relation, (size_t)uses->relations);
    TAKE(effort, (size_t)uses->efforts);
    TAKE(observed, (size_t)uses->measures);
    TAKE(measure, (size_t)uses->measures);
#undef TAKE
}

void zd_uses_copy(const zd_uses *uses, zd_use_parts *to)
{
    for (int i = 0; i < uses->efforts; i++) to->effort[i] = uses->effort[i];
    for (int i = 0; i < uses->measures; i++) to->observed[i] = uses->measure[i];
    for (int i = 0; i < uses->terms; i++) zd_uses_add_term(to, uses->term[i].gauge, uses->term[i].coefficient);
}

void zd_uses_add_term(zd_use_parts *to, int gauge, double coefficient)
{
    to->coefficient[to->terms] = coefficient;
    to->term[to->terms++] = (zd_gauge_term){gauge, coefficient};
}

void zd_uses_add_row(zd_use_parts *to, zd_relation row, zd_row_owner owner)
{
    to->row[to->rows] = row;
    to->owner_of_row[to->rows++] = owner;
}

void zd_uses_add_joint_row(zd_use_parts *to, int first, int nonholonomic, int joint, int component)
{
    const zd_relation row = {first, to->terms - first, nonholonomic, -1, 0, 0, joint};
    zd_uses_add_row(to, row, (zd_row_owner){ZD_OF_JOINT, joint, component});
}

void zd_uses_add_relations(const zd_uses *uses, int nonholonomic, zd_use_parts *to)
{
    for (int i = 0; i < uses->relations; i++) {
        if (uses->relation[i].nonholonomic != nonholonomic) continue;
        to->row_of_relation[i] = to->rows;
        zd_uses_add_row(to, uses->relation[i], (zd_row_owner){ZD_OF_RELATION, i, 0});
    }
}

/* ---- what follows for the system ---- */

static int longest_of(const zd_uses *uses)
{
    int longest = 2;        /* the row of a joint that rolls or advances */
    for (int i = 0; i < uses->relations; i++)
        if (uses->relation[i].terms > longest) longest = uses->relation[i].terms;
    for (int i = 0; i < uses->efforts; i++)
        if (uses->effort[i].terms > longest) longest = uses->effort[i].terms;
    return longest;
}

static int forces_know_velocity(const zd_uses *uses)
{
    for (int i = 0; i < uses->efforts; i++)
        if (uses->effort[i].damping != 0 || uses->effort[i].kind == ZD_EFFORT_LAW) return 1;
    return 0;
}

static int forces_have_power(const zd_uses *uses)
{
    for (int i = 0; i < uses->efforts; i++)
        if (uses->effort[i].damping != 0 || uses->effort[i].kind != ZD_EFFORT_SPRING) return 1;
    return 0;
}

/* Whether a row's rate has a part of its own, dg/dt or a_0 of (5). */
static int rows_have_explicit_rate(const zd_uses *uses)
{
    for (int i = 0; i < uses->relations; i++) {
        const zd_relation *row = uses->relation + i;
        if (row->slope != 0 || (row->nonholonomic && row->constant != 0)) return 1;
        if (row->law >= 0 && (row->nonholonomic || uses->laws_know_time)) return 1;
    }
    return 0;
}

static int knows_time(const zd_uses *uses)
{
    for (int i = 0; i < uses->relations; i++)
        if (uses->relation[i].slope != 0) return 1;
    return uses->law && uses->laws_know_time;
}

zd_planned_uses zd_uses_plan(const zd_uses *uses, const zd_use_parts *from, int mh)
{
    return (zd_planned_uses){
        .relations = uses->relations, .efforts = uses->efforts, .mh = mh, .m = from->rows, .longest = longest_of(uses),
        .term = from->term, .coefficient = from->coefficient, .row = from->row, .owner_of_row = from->owner_of_row,
        .row_of_relation = from->row_of_relation, .effort = from->effort, .observed = from->observed,
        .law = uses->law, .owner = uses->owner, .has_velocity_forces = forces_know_velocity(uses),
    };
}

int zd_uses_terms(const zd_uses *uses, const zd_planned_uses *planned)
{
    int terms = 0;
    if (planned->m) terms |= ZD_C | ZD_XI;
    if (planned->mh) terms |= ZD_PHI;
    if (rows_have_explicit_rate(uses)) terms |= ZD_PHI_T;
    if (forces_have_power(uses)) terms |= ZD_POWER;
    if (!knows_time(uses)) terms |= ZD_TIMELESS;
    return terms;
}
