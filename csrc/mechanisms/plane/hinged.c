/* Constants of a tree in which all bodies turn, found once; and its terms from these. */
#include "hinged.h"

enum { MOST = 200 };            /* bodies: the pairs of more need too much memory */

void zd_hinged_create(zd_hinged *self, zd_arena *arena, size_t bodies, size_t rows)
{
    if (bodies > MOST) return;
#define TAKE(member, count) self->member = zd_arena_bytes(arena, (count) * sizeof *self->member)
    TAKE(angle, bodies + 1);
    TAKE(inertia, bodies + 1);
    TAKE(moment, bodies + 1);
    TAKE(pair, bodies * (bodies + 1) / 2);
    TAKE(closure, rows / 2);
    TAKE(arm, rows / 2 * bodies);
    TAKE(is_closure, rows);
#undef TAKE
}

/* ---- constants ---- */

/* True if no body is free or slides. */
static int is_hinged(const zd_plane_tree *tree)
{
    if (!tree->angles || tree->bodies > MOST) return 0;
    for (int i = 1; i <= tree->bodies; i++)
        if (tree->link[i].hang < ZD_HANGS_TURNING || tree->link[i].hang == ZD_HANGS_SLIDING) return 0;
    return 1;
}

/* Which angle turns each body that has one of its own. */
static void number_angles(zd_hinged *self, const zd_plane_tree *tree)
{
    for (int i = 1, k = 0; i <= tree->bodies; i++)
        if (tree->link[i].hang == ZD_HANGS_TURNING) self->angle[i] = k++;
}

/* A vector in body axes, converted to the parent's axes; only for bodies that are fixed to it, or have no axes of their own. */
static zd_vector in_axes_of_inner(const zd_plane_link *link, zd_vector a)
{
    return link->hang == ZD_HANGS_FIXED ? zd_rotated(link->cosine, link->sine, a) : a;
}

/* First moment (kg m) and second moment (kg m^2) of the mass that turns with a body, about its inboard joint, in its axes. */
typedef struct moments {
    zd_vector first;
    double second;
} moments;

/* Adds the moments of a body to those of its parent: its composite if it is fixed to it, otherwise a point mass at its joint. */
static void add_inward(const zd_plane_tree *tree, int body, const moments *own, moments *inner)
{
    const zd_plane_link *link = tree->link + body;
    zd_vector arm = zd_plus(tree->link[link->inner].far, link->near);
    inner->first = zd_plus(inner->first, zd_times(link->carried, arm));
    inner->second += link->carried * zd_inner(arm, arm);
    if (link->hang != ZD_HANGS_FIXED) return;
    zd_vector first = in_axes_of_inner(link, own->first);
    inner->first = zd_plus(inner->first, first);
    inner->second += own->second + 2 * zd_inner(arm, first);
}

/* M's entries of one angle with those further in. */
static void add_pairs(zd_hinged *self, const zd_plane_tree *tree, int body, int angle)
{
    zd_vector moment = self->moment[angle], arm = tree->link[body].near;
    for (int i = tree->link[body].inner; i; i = tree->link[i].inner) {
        const zd_plane_link *link = tree->link + i;
        arm = zd_plus(arm, link->far);
        if (link->hang != ZD_HANGS_TURNING) {
            arm = zd_plus(in_axes_of_inner(link, arm), link->near);
            continue;
        }
        zd_hinged_pair pair = {self->angle[i], angle, zd_inner(arm, moment), zd_cross(arm, moment)};
        if (pair.K != 0 || pair.X != 0) self->pair[self->pairs++] = pair;
        arm = link->near;
    }
}

static void plan_mass(zd_hinged *self, const zd_plane_tree *tree)
{
    moments all[MOST + 1];
    for (int i = 0; i <= tree->bodies; i++) {
        const zd_plane_link *link = tree->link + i;
        all[i] = (moments){zd_times(link->mass, link->far), link->inertia + link->mass * zd_inner(link->far, link->far)};
    }
    for (int i = tree->bodies; i; i--) add_inward(tree, i, all + i, all + tree->link[i].inner);
    for (int i = 1; i <= tree->bodies; i++) {
        if (tree->link[i].hang != ZD_HANGS_TURNING) continue;
        int angle = self->angle[i];
        self->moment[angle] = all[i].first;
        self->inertia[angle] = all[i].second;
        add_pairs(self, tree, i, angle);
    }
}

/* ---- points that are to coincide ---- */

static void add_arm(zd_hinged *self, zd_closure *to, int angle, double sign, zd_vector along)
{
    for (zd_arm *arm = self->arm + to->first; arm < self->arm + to->first + to->arms; arm++) {
        if (arm->angle != angle) continue;
        arm->along = zd_plus(arm->along, zd_times(sign, along));
        return;
    }
    self->arm[to->first + to->arms++] = (zd_arm){angle, zd_times(sign, along)};
}

/* Adds the place of a point of a body, with a sign. */
static void add_point(zd_hinged *self, const zd_plane_tree *tree, int body, const double *point, double sign, zd_closure *to)
{
    zd_vector arm = {point[0], point[1]};
    for (int i = body; i; i = tree->link[i].inner) {
        const zd_plane_link *link = tree->link + i;
        arm = zd_plus(arm, link->far);
        if (link->hang == ZD_HANGS_TURNING) {
            add_arm(self, to, self->angle[i], sign, arm);
            arm = link->near;
        } else {
            arm = zd_plus(in_axes_of_inner(link, arm), link->near);
        }
    }
    to->constant = zd_plus(to->constant, zd_times(sign, arm));
}

static int is_plain(const zd_relation *row, const double *coefficient)
{
    return row->terms == 1 && row->law < 0 && !row->nonholonomic && row->slope == 0 && coefficient[row->first] == 1;
}

static int have_same_points(const zd_plane_quantity *a, const zd_plane_quantity *b)
{
    return a->first == b->first && a->second == b->second && a->point1[0] == b->point1[0] && a->point1[1] == b->point1[1]
           && a->point2[0] == b->point2[0] && a->point2[1] == b->point2[1];
}

static void plan_closures(zd_hinged *self, const zd_plane_tree *tree, const zd_planned_elements *elements, const zd_plane_quantity *quantity)
{
    const zd_relation *row = elements->row;
    for (int i = 0; i + 1 < elements->mh; i++) {
        if (!is_plain(row + i, elements->coefficient) || !is_plain(row + i + 1, elements->coefficient)) continue;
        const zd_plane_quantity *x = quantity + elements->term[row[i].first].quantity;
        const zd_plane_quantity *y = quantity + elements->term[row[i + 1].first].quantity;
        if (x->kind != ZD_PLANE_X || y->kind != ZD_PLANE_Y || !have_same_points(x, y)) continue;
        zd_closure *to = self->closure + self->closures++;
        *to = (zd_closure){.row = i, .first = self->arms, .constant = {-x->zero - row[i].constant, -y->zero - row[i + 1].constant}};
        add_point(self, tree, x->second, x->point2, 1, to);
        add_point(self, tree, x->first, x->point1, -1, to);
        self->arms += to->arms;
        self->is_closure[i] = self->is_closure[i + 1] = 1;
        i++;
    }
}

void zd_hinged_plan(zd_hinged *self, const zd_plane_tree *tree, const zd_planned_elements *elements, const zd_plane_quantity *quantity)
{
    self->is_complete = is_hinged(tree);
    if (!self->is_complete) return;
    number_angles(self, tree);
    plan_mass(self, tree);
    plan_closures(self, tree, elements, quantity);
}

/* ---- terms ---- */

void zd_hinged_mass(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, double *M)
{
    int n = tree->angles;
    const double *sine = sines + n, *cosine = sine + n;
    for (int i = 0; i < n; i++) M[tree->angle[i] * (n + 1)] = self->inertia[i];
    for (const zd_hinged_pair *pair = self->pair; pair < self->pair + self->pairs; pair++) {
        int i = pair->i, j = pair->j, k = tree->angle[i], l = tree->angle[j];
        double cosine_of_d = cosine[i] * cosine[j] + sine[i] * sine[j], sine_of_d = sine[j] * cosine[i] - cosine[j] * sine[i];
        M[k * n + l] = M[l * n + k] = pair->K * cosine_of_d - pair->X * sine_of_d;
    }
}

void zd_hinged_bias(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, const double *v, double *d)
{
    int n = tree->angles;
    const double *sine = sines + n, *cosine = sine + n;
    for (const zd_hinged_pair *pair = self->pair; pair < self->pair + self->pairs; pair++) {
        int i = pair->i, j = pair->j, k = tree->angle[i], l = tree->angle[j];
        double cosine_of_d = cosine[i] * cosine[j] + sine[i] * sine[j], sine_of_d = sine[j] * cosine[i] - cosine[j] * sine[i];
        double across = pair->K * sine_of_d + pair->X * cosine_of_d;
        d[k] -= v[l] * v[l] * across;
        d[l] += v[k] * v[k] * across;
    }
}

void zd_hinged_weight(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, zd_vector gravity, double *f)
{
    int n = tree->angles;
    const double *sine = sines + n, *cosine = sine + n;
    for (int i = 0; i < n; i++) f[tree->angle[i]] = zd_cross(zd_rotated(cosine[i], sine[i], self->moment[i]), gravity);
}

void zd_hinged_close(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, const double *v, int want, const zd_terms *out)
{
    int n = tree->angles;
    const double *sine = sines + n, *cosine = sine + n;
    for (const zd_closure *closure = self->closure; closure < self->closure + self->closures; closure++) {
        zd_vector apart = closure->constant, xi = {0, 0};
        for (const zd_arm *arm = self->arm + closure->first; arm < self->arm + closure->first + closure->arms; arm++) {
            int i = arm->angle, k = tree->angle[i];
            zd_vector turned = zd_rotated(cosine[i], sine[i], arm->along);
            apart = zd_plus(apart, turned);
            if (want & ZD_XI) xi = zd_plus(xi, zd_times(v[k] * v[k], turned));
            if (!(want & ZD_C)) continue;
            out->C[closure->row * n + k] = -turned.y;                       /* (5) */
            out->C[(closure->row + 1) * n + k] = turned.x;
        }
        if (want & ZD_PHI) out->Phi[closure->row] = apart.x, out->Phi[closure->row + 1] = apart.y;      /* (3) */
        if (want & ZD_XI) out->xi[closure->row] = xi.x, out->xi[closure->row + 1] = xi.y;               /* (6) */
        if (want & ZD_PHI_T) out->Phi_t[closure->row] = out->Phi_t[closure->row + 1] = 0;
    }
}
