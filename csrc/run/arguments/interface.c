/* Checks of the optional members of zd_system, one function per pointer: their sizes must match those of the system, and declared arrays
 * and functions must exist. Messages count from 0, as the interface does.
 */
#include "checks.h"


#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "../../point/point.h"

typedef struct text {
    char *here;
    int size;
} text;

static int refuse(text message, const char *sentence, ...)
{
    va_list values;
    va_start(values, sentence);
    vsnprintf(message.here, message.size, sentence, values);
    va_end(values);
    return ZD_BAD_ARGUMENT;
}

static const double LARGEST_MATRICES = 0x1p28;      /* entries; offsets of packed matrices are ints */

static int is_no_size(int scratch) { return scratch < 0 || scratch > ZD_LARGEST * ZD_LARGEST; }

static int is_no_count(int count) { return count < 0 || count > ZD_LARGEST; }

/* ---- structure ---- */

static int check_blocks(const zd_system *system, text message)
{
    const zd_structure *structure = system->structure;
    int nq = 0, nv = 0;
    if (structure->blocks < 1 || structure->blocks > system->nv || !structure->coordinates || !structure->velocities)
        return refuse(message, "structure: there must be 1 to %d blocks, each with its coordinates and velocities, not %d", system->nv,
                      structure->blocks);
    for (int b = 0; b < structure->blocks; b++) {
        int p = structure->coordinates[b], v = structure->velocities[b], mass = structure->mass ? structure->mass[b] : 0;
        if (p < 1 || v < 1 || p > system->nq || v > system->nv)
            return refuse(message, "structure: block %d must have at least one coordinate and one velocity, not %d and %d", b, p, v);
        if (p != v && !(system->provides & ZD_A))
            return refuse(message, "structure: block %d has %d coordinates and %d velocities: the system must provide a kinematic matrix",
                          b, p, v);
        if (mass & ~(ZD_CONSTANT | ZD_DIAGONAL))
            return refuse(message, "structure: the mass of block %d must be a sum of ZD_CONSTANT and ZD_DIAGONAL, not %d", b, mass);
        nq += p, nv += v;
    }
    if (nq == system->nq - system->followers && nv == system->nv) return ZD_DONE;
    return refuse(message, "structure: the blocks must have the %d coordinates and %d velocities of the system, not %d and %d",
                  system->nq - system->followers, system->nv, nq, nv);
}

static int check_touched(const zd_structure *structure, int g, text message)
{
    int first = structure->first[g], end = structure->first[g + 1];
    if (first >= end || end - first > structure->blocks || (g == 0 && first != 0))
        return refuse(message, "structure: group %d must touch at least one block, the first group from 0 on, not those at %d to %d of "
                      "the list", g, first, end - 1);
    for (int i = first; i < end; i++) {
        int b = structure->block[i];
        if (b < 0 || b >= structure->blocks || (i > first && b <= structure->block[i - 1]))
            return refuse(message, "structure: the blocks of group %d must increase, from 0 to %d at most; it touches block %d", g,
                          structure->blocks - 1, b);
    }
    return ZD_DONE;
}

static int check_groups_of_rows(const zd_system *system, text message)
{
    const zd_structure *structure = system->structure;
    int m = system->mh + system->mn, rows = 0, status = ZD_DONE;
    if (structure->groups < 0 || structure->groups > m || (structure->groups && !(structure->rows && structure->first && structure->block)))
        return refuse(message, "structure: there must be at most %d groups, each with its rows and the blocks it touches, not %d", m,
                      structure->groups);
    for (int g = 0; g < structure->groups && !status; g++) {
        if (structure->rows[g] < 1 || structure->rows[g] > m - rows)
            return refuse(message, "structure: group %d must have at least one row, and at most the %d of %d that remain, not %d", g,
                          m - rows, m, structure->rows[g]);
        if (rows < system->mh && rows + structure->rows[g] > system->mh)
            return refuse(message, "structure: the rows of group %d must all be holonomic, or all nonholonomic", g);
        rows += structure->rows[g];
        status = check_touched(structure, g, message);
    }
    if (status || rows == m) return status;
    return refuse(message, "structure: the groups must have the %d rows of the system, not %d", m, rows);
}

/* Number of entries of all blocks of A, M and C, as a double: it may exceed the range of int. */
static double numbers_in(const zd_structure *structure)
{
    double numbers = 0;
    for (int b = 0; b < structure->blocks; b++)
        numbers += ((double)structure->coordinates[b] + structure->velocities[b]) * structure->velocities[b];
    for (int g = 0; g < structure->groups; g++)
        for (int i = structure->first[g]; i < structure->first[g + 1]; i++)
            numbers += (double)structure->rows[g] * structure->velocities[structure->block[i]];
    return numbers;
}

static int check_structure(const zd_system *system, text message)
{
    if (!system->structure) return ZD_DONE;
    if (system->provides & ZD_COMPLEMENT)
        return refuse(message, "structure: a system with structure must not provide a complement D of its own");
    int status = check_blocks(system, message);
    if (!status) status = check_groups_of_rows(system, message);
    if (!status && numbers_in(system->structure) > LARGEST_MATRICES)
        return refuse(message, "structure: blocks and groups must have at most %.3g numbers in all, not %.3g", LARGEST_MATRICES,
                      numbers_in(system->structure));
    return status;
}

/* ---- other members ---- */

static int check_operations(const zd_system *system, text message)
{
    const zd_operations *operations = system->operations;
    if (!operations || (!operations->subtract_weighted && !operations->add_weighted)) return ZD_DONE;
    if (operations->times_C && operations->subtract_weighted && operations->add_weighted && zd_mass_is(system, ZD_DIAGONAL)) return ZD_DONE;
    return refuse(message, "operations: subtract_weighted and add_weighted must come together, with times_C, and a structure whose M is "
                  "diagonal");
}

/* Checks an order: each constraint outside all groups is eliminated once, for as many different velocities, in solves numbered from 0. */
static int is_an_elimination(const zd_system *system, const zd_elimination *order, int embeds)
{
    int m = zd_own_constraints(system), last = -1;
    if (!(embeds ? order->embed != NULL : order->accelerate != NULL) || order->solves < 0 || order->solves > m ||
        (order->solves == 0) != (m == 0))
        return 0;
    if (m && !(order->correct && order->solve && order->row && order->column)) return 0;
    for (int k = 0; k < m; k++) {
        int row = order->row[k], column = order->column[k];
        if (row < 0 || row >= m || column < 0 || column >= system->nv || order->solve[k] < last || order->solve[k] > last + 1) return 0;
        for (int i = 0; i < k; i++)
            if (order->row[i] == row || order->column[i] == column) return 0;
        last = order->solve[k];
    }
    return last + 1 == order->solves;
}

static int check_orders(const zd_system *system, int set, text message)
{
    const zd_closed_form *closed_form = &system->closed_form[set];
    for (int i = 0; i < closed_form->orders + closed_form->embeddings; i++) {
        const int embeds = i >= closed_form->orders;
        const zd_elimination *order = embeds ? closed_form->embedding + (i - closed_form->orders) : closed_form->order + i;
        if (!is_an_elimination(system, order, embeds))
            return refuse(message, "closed_form: order %d of set %d must eliminate %d rows, each once, for as many of %d velocities", i, set,
                          zd_own_constraints(system), system->nv);
    }
    return ZD_DONE;
}

static int is_no_number_of_orders(int count, const zd_elimination *order)
{
    return count < 0 || count > 4 || (count > 0 && !order);
}

static int check_closed_form(const zd_system *system, text message)
{
    int known[ZD_AVX512 + 1] = {0};
    if (system->closed_forms < 0 || system->closed_forms > 12 || (system->closed_forms > 0) != (system->closed_form != NULL))
        return refuse(message, "closed_form: there must be at most one set of functions for each vector unit and number of lanes, "
                      "not %d sets",
                      system->closed_forms);
    for (int i = 0; i < system->closed_forms; i++) {
        const zd_closed_form *closed_form = &system->closed_form[i];
        if (is_no_number_of_orders(closed_form->orders, closed_form->order)
            || is_no_number_of_orders(closed_form->embeddings, closed_form->embedding))
            return refuse(message, "closed_form: set %d must have arrays of up to 4 orders of elimination, and of up to 4 for independent "
                          "velocities, not of %d and %d", i, closed_form->orders, closed_form->embeddings);
        if (!(closed_form->orders + closed_form->embeddings))
            return refuse(message, "closed_form: set %d must have an order of elimination", i);
        if (closed_form->lanes != 1 && closed_form->lanes != 2 && closed_form->lanes != 4 && closed_form->lanes != 8)
            return refuse(message, "closed_form: set %d must have 1, 2, 4 or 8 lanes, not %d", i, closed_form->lanes);
        if ((unsigned)closed_form->unit > ZD_AVX512)
            return refuse(message, "closed_form: the vector unit of set %d must be from 0 to 2, not %d", i, (int)closed_form->unit);
        if (known[closed_form->unit] & closed_form->lanes)
            return refuse(message, "closed_form: set %d must be the only one with %d lanes for its vector unit", i, closed_form->lanes);
        known[closed_form->unit] |= closed_form->lanes;
        int status = check_orders(system, i, message);
        if (status) return status;
    }
    return ZD_DONE;
}

static int check_measures(const zd_system *system, text message)
{
    const zd_measures *measures = system->measures;
    if (!measures) return ZD_DONE;
    const int largest = ZD_LARGEST_PACKED;      /* mechanisms have some 20 for each body */
    if (measures->count < 0 || measures->count > largest || (measures->count && (!measures->measure || !measures->evaluate)))
        return refuse(message, "measures: there must be 0 to %d, with a function that evaluates them, not %d", largest, measures->count);
    if (is_no_size(measures->scratch)) return refuse(message, "measures: their scratch must be a size, not %d", measures->scratch);
    for (int i = 0; i < measures->count; i++) {
        const zd_measure *measure = &measures->measure[i];
        if (!measure->name || !*measure->name || !measure->unit)
            return refuse(message, "measures: measure %d must have a name and a unit", i);
        if (measure->size < 1 || measure->size > ZD_LARGEST)
            return refuse(message, "measures: %s must have 1 to 8192 components, not %d", measure->name, measure->size);
        if ((int)measure->depends < ZD_OF_POSITIONS || (int)measure->depends > ZD_OF_ACCELERATIONS)
            return refuse(message, "measures: %s must depend on positions, velocities or accelerations (0 to 2), not on %d", measure->name,
                          (int)measure->depends);
    }
    return ZD_DONE;
}

static int check_series(const zd_system *system, text message)
{
    const zd_series *series = system->series;
    if (!series || (series->evaluate && !is_no_size(series->scratch))) return ZD_DONE;
    return refuse(message, "series: they must have evaluate(), and a scratch that is a size, not %d", series->scratch);
}

static int check_jacobian(const zd_system *system, text message)
{
    const zd_jacobian *jacobian = system->jacobian;
    if (!jacobian || (jacobian->evaluate && !is_no_size(jacobian->scratch))) return ZD_DONE;
    return refuse(message, "jacobian: it must have evaluate(), and a scratch that is a size, not %d", jacobian->scratch);
}

static int check_residuals(const zd_system *system, text message)
{
    const zd_residuals *residuals = system->residuals;
    if (!residuals || (residuals->evaluate && !is_no_size(residuals->scratch))) return ZD_DONE;
    return refuse(message, "residuals: they must have evaluate(), and a scratch that is a size, not %d", residuals->scratch);
}

static int check_magnitudes(const zd_system *system, text message)
{
    if (!system->magnitudes || !is_no_size(system->magnitudes_scratch)) return ZD_DONE;
    return refuse(message, "magnitudes: their scratch must be a size, not %d", system->magnitudes_scratch);
}

static int check_inputs(const zd_system *system, text message)
{
    if (is_no_count(system->inputs) || (system->inputs && !system->input))
        return refuse(message, "inputs: there must be 0 to 8192, each with its name, unit and initial value, not %d", system->inputs);
    for (int i = 0; i < system->inputs; i++) {
        const zd_input *input = &system->input[i];
        if (!input->name || !*input->name || !input->unit) return refuse(message, "inputs: input %d must have a name and a unit", i);
        if (input->kind != ZD_EFFORT && input->kind != ZD_SPEED)
            return refuse(message, "inputs: %s must be an effort or a speed", input->name);
        if (!isfinite(input->initial)) return refuse(message, "inputs: the initial value of %s must be finite", input->name);
    }
    return ZD_DONE;
}

/* Checks groups of constraints that can be switched, and what bounds their friction. */
static int check_switched_group(const zd_system *system, int i, text message)
{
    const zd_group *group = &system->group[i];
    const int m = system->mh + system->mn, most = group->kind == ZD_TWO_SIDED ? m : group->kind == ZD_FRICTION ? 2 : 1;
    if (!group->name || !*group->name) return refuse(message, "groups: group %d must have a name", i);
    if (group->rows < 1 || group->first < 0 || group->first > m - group->rows || group->rows > most)
        return refuse(message, "groups: %s must have rows among the system's %d, at most %d of them, not %d rows from row %d on", group->name,
                      m, most, group->rows, group->first);
    if (group->first < system->mh && group->first + group->rows > system->mh)
        return refuse(message, "groups: %s must have rows of one kind, holonomic or not", group->name);
    if (group->kind == ZD_ONE_SIDED && group->first >= system->mh)
        return refuse(message, "groups: %s must have a holonomic row", group->name);
    if ((group->kind == ZD_ONE_SIDED || group->kind == ZD_ONE_WAY) && group->sign != 1 && group->sign != -1)
        return refuse(message, "groups: %s must have a sign of 1 or -1", group->name);
    if (!(group->restitution >= 0 && group->restitution <= 1) || !isfinite(group->value))
        return refuse(message, "the restitution of '%s' must be 0 to 1, not %g, and its limit finite", group->name, group->restitution);
    if (group->range < 0 || group->range > system->mh || (group->range && !(group->lower < group->upper)))
        return refuse(message, "groups: the range of %s must be of a holonomic row, with lower less than upper", group->name);
    if (group->opposite < 0 || group->opposite > system->groups
        || (group->opposite && system->group[group->opposite - 1].kind != ZD_ONE_SIDED))
        return refuse(message, "groups: the opposite side of %s must be a one-sided group", group->name);
    if (group->kind != ZD_FRICTION) return ZD_DONE;
    if (!(group->friction[1] >= 0 && group->friction[0] >= group->friction[1]))
        return refuse(message, "friction of '%s' must be at least 0, and sliding friction at most static friction, not %g and %g",
                      group->name, group->friction[1], group->friction[0]);
    if (group->normal < 0 || group->normal > system->groups || (group->normal && system->group[group->normal - 1].kind != ZD_ONE_SIDED))
        return refuse(message, "groups: the normal of %s must be a one-sided group", group->name);
    if (group->loads < 0 || group->loads > 4 || (group->at_ends && group->loads % 2)
        || (group->loads && (group->load < 0 || group->load > m - group->loads)))
        return refuse(message, "groups: the load of %s must be multipliers of at most 4 existing rows, half of them for each end if it has "
                      "two", group->name);
    return ZD_DONE;
}

enum { MAX_GROUPS = 1024 };      /* a change of phase takes a time in proportion to their number */

static int check_switched_groups(const zd_system *system, text message)
{
    int status = ZD_DONE;
    if (system->groups < 0 || system->groups > MAX_GROUPS || (system->groups && !system->group))
        return refuse(message, "groups: there must be 0 to %d, each with its name and rows, not %d", MAX_GROUPS, system->groups);
    for (int i = 0; i < system->groups && !status; i++) status = check_switched_group(system, i, message);
    return status;
}

static int check_quaternions(const zd_system *system, text message)
{
    int end = 0;
    if (system->quaternions < 0 || system->quaternions > system->nq / 4 || (system->quaternions && !system->quaternion))
        return refuse(message, "quaternions: there must be 0 to %d, each with its first coordinate, not %d", system->nq / 4,
                      system->quaternions);
    if (system->quaternions && !(system->provides & ZD_A))
        return refuse(message, "quaternions: a system with quaternions must have a kinematic matrix, since their rates are not velocities");
    for (int k = 0; k < system->quaternions; k++) {
        const int first = system->quaternion[k];
        if (first < end || first > system->nq - 4)
            return refuse(message, "quaternions: quaternion %d must be four of the %d coordinates, after those of the previous one; it "
                          "begins at p[%d]", k, system->nq, first);
        end = first + 4;
        for (int i = first; i < end; i++)
            if (system->lengths && system->lengths[i])
                return refuse(message, "quaternions: p[%d] is in quaternion %d, and must not be declared a length", i, k);
    }
    return ZD_DONE;
}

static int check_followers(const zd_system *system, text message)
{
    const int may_be = system->nq > 0 ? system->nq - 1 : 0;
    if (system->followers < 0 || system->followers > may_be || (system->followers && !system->follow))
        return refuse(message, "followers: there must be 0 to %d, after the other coordinates, with follow(), not %d", may_be,
                      system->followers);
    const int has_rates = system->structure ? system->operations && system->operations->times_A : system->provides & ZD_A;
    if (system->followers && !has_rates)
        return refuse(message, "followers: their rates must be in A, or, for a system with structure, in times_A");
    return ZD_DONE;
}

int zd_check_interface(const zd_system *system, char *message, int size)
{
    static int (*const checks[])(const zd_system *, text) = {
        check_followers, check_structure, check_operations, check_closed_form, check_measures, check_series, check_jacobian,
        check_residuals, check_magnitudes, check_inputs, check_switched_groups, check_quaternions,
    };
    int status = ZD_DONE;
    for (size_t i = 0; i < sizeof checks / sizeof checks[0] && !status; i++) status = checks[i](system, (text){message, size});
    return status;
}
