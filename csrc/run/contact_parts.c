/* Contacts are coupled by entries of W, and friction with its normal force. Each part of coupled contacts is solved separately. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "contacts.h"

static const double COUPLING = 1e-13;       /* entry of W, relative to the diagonal, below which it is rounding */

typedef struct part {
    int count;
    int row[ZD_MAX_CANDIDATES];     /* (count,) candidates, normal rows first */
} part;

static int are_coupled(const zd_contacts *it, int j, int k)
{
    const double *W = it->W;
    const size_t n = it->count;
    return it->row[j].normal == k + 1 || it->row[k].normal == j + 1
        || W[j * n + k] * W[j * n + k] > COUPLING * COUPLING * W[j * n + j] * W[k * n + k];
}

void zd_contacts_find_parts(zd_contacts *it)
{
    int found[ZD_MAX_TOUCHING];
    for (int k = 0; k < it->count; k++) it->part[k] = -1;
    it->parts = 0;
    for (int first = 0; first < it->count; first++) {
        if (it->part[first] >= 0 || it->is_blocked[first]) continue;
        it->part[first] = it->parts;
        found[0] = first;
        for (int i = 0, count = 1; i < count; i++)
            for (int k = first; k < it->count; k++)
                if (it->part[k] < 0 && !it->is_blocked[k] && are_coupled(it, found[i], k)) it->part[k] = it->parts, found[count++] = k;
        it->parts++;
    }
}

/* Lists the candidates of a part among the first rows; 0: they are too many. */
static int list(const zd_contacts *it, int index, int rows, part *to)
{
    to->count = 0;
    for (int k = 0; k < rows; k++) {
        if (it->part[k] != index) continue;
        if (to->count == ZD_MAX_CANDIDATES) return 0;
        to->row[to->count++] = k;
    }
    return 1;
}

static void take_W(const zd_contacts *it, const part *of, double *W)
{
    for (int j = 0; j < of->count; j++)
        for (int k = 0; k < of->count; k++) W[j * of->count + k] = it->W[(size_t)of->row[j] * it->count + of->row[k]];
}

/* Number of solutions of a part, as of zd_problem_solve(). */
static int solve_part(zd_contacts *it, const part *of)
{
    const int n = of->count;
    zd_candidate row[ZD_MAX_CANDIDATES];
    signed char state[ZD_MAX_CANDIDATES];
    int tie[ZD_MAX_CANDIDATES], opens = 0;
    double W[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES], b[ZD_MAX_CANDIDATES], factor[ZD_MAX_CANDIDATES], z[ZD_MAX_CANDIDATES],
        w[ZD_MAX_CANDIDATES], direction[ZD_MAX_CANDIDATES];
    take_W(it, of, W);
    for (int i = 0; i < n; i++) {
        const int k = of->row[i];
        row[i] = it->row[k], b[i] = it->b[k], direction[i] = it->direction[k];
        opens |= it->ends[k] != ZD_OPEN;
        if (row[i].normal <= 0) continue;
        row[i].normal = 0;
        for (int j = 0; j < i; j++)
            if (of->row[j] == it->row[k].normal - 1) row[i].normal = j + 1;
        if (!row[i].normal) row[i].bound[0] = row[i].bound[1] = 0;      /* its normal row is blocked */
    }
    const int is_min_norm = zd_has_pairs(it->phases->full);
    zd_contact_problem problem = {n, row, W, b, is_min_norm, opens, state, tie, factor, z, w, direction, 0, 0, it->scratch};
    const int found = zd_problem_solve(&problem);
    it->free_forces += problem.free_forces, it->free_normals += problem.free_normals;
    for (int i = 0; i < n && found == 1; i++) {
        const int k = of->row[i];
        it->state[k] = state[i], it->tie[k] = tie[i] < 0 ? -1 : of->row[tie[i]], it->factor[k] = factor[i];
        it->z[k] = z[i], it->after[k] = w[i], it->direction[k] = direction[i];
    }
    return found;
}

int zd_contacts_solve(zd_contacts *it, int rows, const char *what)
{
    part one;
    it->free_forces = it->free_normals = 0;
    for (int k = 0; k < rows; k++)
        if (it->part[k] < 0) it->state[k] = ZD_IDLE, it->tie[k] = -1, it->z[k] = it->after[k] = 0;
    for (int index = 0; index < it->parts; index++) {
        const int found = list(it, index, rows, &one) ? solve_part(it, &one) : -1;
        if (found == 1) continue;
        const char *how = found == -2 ? "the normal forces that sliding friction depends on must be unique; use fewer contacts"
                        : found < 0 ? "too many coupled contacts change at one instant; use fewer contacts"
                        : !found ? rows > it->normals ? "no solution exists, as in Painleve's paradox: friction must be smaller"
                                                      : "no solution exists: drives and joints must allow the bodies to stop"
                        : "several solutions exist, as in Painleve's paradox: friction must be smaller";
        snprintf(it->run->outcome.message, ZD_MESSAGE, "%s of contact '%s' and of the contacts that act with it: %s", what,
                 zd_candidate_group(it, one.row[0])->name, how);
        return ZD_SEVERAL_MOTIONS;
    }
    return ZD_DONE;
}

int zd_contacts_find_correction(const zd_contacts *it, const double *w, double *z)
{
    const int is_dependent = it->free_forces || it->free_normals;       /* rows then contradict each other by rounding */
    memset(z, 0, it->count * sizeof *z);
    for (int index = 0; index < it->parts; index++) {
        double A[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES], x[ZD_MAX_CANDIDATES];
        part all, active = {0};
        list(it, index, it->count, &all);
        for (int i = 0; i < all.count; i++)
            if (it->state[all.row[i]] == ZD_CLOSED) active.row[active.count++] = all.row[i];
        take_W(it, &active, A);
        for (int i = 0; i < active.count; i++) x[i] = -w[active.row[i]];
        if (!zd_equations_solve(active.count, A, x) && !is_dependent) return ZD_SINGULAR;
        for (int i = 0; i < active.count; i++) z[active.row[i]] = x[i];
    }
    return ZD_DONE;
}
