#include "block.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../mechanisms/common/assembly/given.h"
#include "../workspace.h"
#include "made.h"

static const double CLOSED = 1e-6;          /* relative to the mechanism's length: gap of joints that can close */
static const double EQUAL = 1e-4;           /* relative: difference of gaps below which the first one is named */
static const char *const HINT = "; look at the lengths, or draw it nearer";
enum { NAMED = 3, MAX_DENSE = 1000 };            /* joints in a sentence; constraints or velocities of dense matrices */

/* ---- gaps at a position ---- */

typedef struct gaps {
    const zd_block *block;
    int names_loops;                        /* 1 in the plane, unless p is of absolute coordinates of many bodies */
    double *Phi, *v, *scratch;              /* (mh,); (nv,) zeros; of the system */
    double *open;                           /* (joints,): m; largest residual where loops are not named, m or rad */
    double *p;                              /* (nq,) with the smallest gaps */
    int *role, *of_loop;                    /* (mh,) of zd_assembly_problem; (bodies + 1 + joints,) */
} gaps;

static gaps create(zd_arena *arena, const zd_block *block)
{
    const zd_system *system = zd_block_system(block);
    const size_t joints = zd_block_count(&block->layout, ZD_BLOCK_JOINTS), bodies = zd_block_bodies(block);
    const size_t mh = system->mh, nv = system->nv;
    return (gaps){.block = block, .Phi = zd_arena_doubles(arena, mh),
                  .v = zd_arena_doubles(arena, nv), .scratch = zd_arena_doubles(arena, system->scratch),
                  .open = zd_arena_doubles(arena, joints), .p = zd_arena_doubles(arena, system->nq),
                  .role = zd_arena_ints(arena, mh),
                  .of_loop = zd_arena_ints(arena, (joints + bodies + 1))};
}

/* open <- gaps of all joints at p; returns a status of the core. */
static int read_gaps(const gaps *self, const double *p)
{
    const zd_block *block = self->block;
    const zd_system *system = zd_block_system(block);
    const zd_terms terms = {.Phi = self->Phi, .scratch = self->scratch};
    const int status = system->evaluate(system->data, ZD_PHI | ZD_MOVED, 0, p, self->v, &terms);
    zd_clear(zd_block_count(&block->layout, ZD_BLOCK_JOINTS), self->open);
    for (int row = 0; !status && row < system->mh; row++) {
        const zd_constraint_owner *owner = block->names.owner + row;
        if (owner->owner != ZD_OF_JOINT) continue;
        double *open = self->open + owner->index;
        if (!self->names_loops) *open = fmax(*open, fabs(self->Phi[row]));
        else if (!block->layout.of->is_angle_row(&block->layout, owner->index, owner->component))
            *open = sqrt(*open * *open + self->Phi[row] * self->Phi[row]);
    }
    return status;
}

static int most_open(const gaps *self)
{
    int most = 0;
    for (int joint = 1; joint < zd_block_count(&self->block->layout, ZD_BLOCK_JOINTS); joint++)
        if (self->open[joint] > self->open[most] + EQUAL * fabs(self->open[most])) most = joint;
    return most;
}

static void name_joints(const gaps *self, zd_complaint to)
{
    if (self->open[most_open(self)] <= CLOSED * zd_block_length(self->block)) {
        zd_append(&to, "the drawing must be near a position in which all joints close; there is one, but it was not found from here");
        return;
    }
    zd_append(&to, "the joints cannot all close: nearest to it there stay open ");
    for (int i = 0; i < NAMED && i < zd_block_count(&self->block->layout, ZD_BLOCK_JOINTS); i++) {
        const int joint = most_open(self);
        zd_append(&to, "%s'%s' by %.3g", i ? ", " : "", zd_block_joint_name(&self->block->layout, joint), self->open[joint]);
        self->open[joint] = -1;
    }
    zd_append(&to, " (m, or rad)%s", HINT);
}

static void name_loop(const gaps *self, int joint, zd_complaint to)
{
    zd_block_name_loop(&self->block->layout, joint, self->of_loop, &to);
    zd_append(&to, ", cannot close: it stays open by %.3g m at '%s'%s", self->open[joint],
              zd_block_joint_name(&self->block->layout, joint), HINT);
}

/* ---- smallest gaps ---- */

/* open <- gaps in the positions, found from p on, with the smallest gap of one joint, or of all for -1; returns a status of the core. */
static int close_joint(const gaps *self, const double *p, int joint)
{
    const zd_system *system = zd_block_system(self->block);
    for (int row = 0; row < system->mh; row++) {
        const zd_constraint_owner *owner = self->block->names.owner + row;
        const int is_closed = owner->owner == ZD_OF_JOINT && (joint < 0 || owner->index == joint);
        self->role[row] = is_closed ? ZD_ROLE_JOINT : ZD_ROLE_IGNORED;
    }
    const zd_assembly_problem given = {.system = system, .length = zd_block_length(self->block), .role = self->role};
    zd_copy_all(system->nq, p, self->p);
    const int status = zd_assembly_minimize(&given, self->p);
    return status ? status : read_gaps(self, self->p);
}

/* Joint whose loop, taken alone, stays open most; -1: each can close. */
static int find_open_loop(const gaps *self, const double *p)
{
    const zd_constraint_owner *owner = self->block->names.owner;
    double most = CLOSED * zd_block_length(self->block);
    int found = -1;
    for (int row = 0; row < zd_block_system(self->block)->mh; row++) {
        if (owner[row].owner != ZD_OF_JOINT || owner[row].component || close_joint(self, p, owner[row].index)) continue;
        if (!(self->open[owner[row].index] > most)) continue;
        found = owner[row].index;
        most = (1 + EQUAL) * self->open[found];
    }
    return found;
}

/* Writes the sentence on the gaps at p, or on the smallest ones from there on, if any exceeds `least`; returns a status of the core. */
static int explain(const gaps *self, const double *p, int is_smallest, double least, zd_complaint to)
{
    const int alone = self->names_loops ? find_open_loop(self, p) : -1;
    const int status = is_smallest ? read_gaps(self, p) : close_joint(self, p, alone);
    if (status) return status;
    const int joint = alone < 0 ? most_open(self) : alone;
    if (self->open[joint] <= least) return ZD_DONE;
    if (alone >= 0) name_loop(self, joint, to);
    else name_joints(self, to);
    return ZD_DONE;
}

static int find(const zd_block *block, const double *p, int is_smallest, double least, zd_complaint to)
{
    if (!zd_block_count(&block->layout, ZD_BLOCK_NAMES) || !zd_block_count(&block->layout, ZD_BLOCK_JOINTS)) return ZD_BAD_ARGUMENT;
    zd_arena arena = {0};
    create(&arena, block);
    if (!zd_arena_allocate(&arena)) return ZD_NO_MEMORY;
    gaps self = create(&arena, block);
    self.names_loops = block->layout.of->freedoms && !is_smallest;
    const int status = explain(&self, p, is_smallest, least, to);
    zd_release(arena.base);
    return status;
}

int zd_block_explain_gaps(const zd_block *block, const double *p, int is_smallest, char *message, int message_size)
{
    return find(block, p, is_smallest, -1, (zd_complaint){message, message_size});
}

/* ---- from the start of any block ---- */

/* Copy of the block with these inboard joints (bodies,) and without a start, whose size depends on them; NULL: it is not made. */
static zd_block *with_inboard(const zd_block *block, const int *inboard)
{
    const zd_block_part *body = block->layout.part + ZD_BLOCK_BODIES, *start = block->layout.part + ZD_BLOCK_START;
    const size_t first = start->word - block->word, end = first + (size_t)start->count, all = block->size / sizeof(double);
    const size_t words = all - (size_t)start->count;
    double *copy = zd_allocate(block->size);
    if (!copy) return NULL;
    memcpy(copy, block->word, first * sizeof *copy);
    memcpy(copy + first, block->word + end, (all - end) * sizeof *copy);
    copy[2] = (double)words;
    copy[4 + ZD_BLOCK_START] = 0;
    for (int i = 0; i < body->count; i++) copy[(body->word - block->word) + (i + 1) * body->width - 1] = inboard[i];
    zd_block *made = zd_block_create(copy, words * sizeof *copy, NULL, 0);
    zd_release(copy);
    return made;
}

/* The block in the coordinates in which its gaps are found: along its tree, or a new one, in the plane, absolute ones in space. */
static zd_block *for_gaps(const zd_block *block)
{
    const zd_block_layout *layout = &block->layout;
    const int bodies = zd_block_bodies(block), is_along_tree = layout->of->freedoms != NULL;
    int *inboard = zd_allocate((2 * (size_t)bodies + 1) * sizeof *inboard);
    if (!inboard) return NULL;
    for (int i = 0; i < bodies; i++) inboard[i] = is_along_tree ? zd_block_inboard(layout, i + 1) : -1;
    if (is_along_tree && !zd_block_has_tree(layout)) zd_block_grow_tree(layout, inboard, inboard + bodies);
    zd_block *made = with_inboard(block, inboard);
    zd_release(inboard);
    return made;
}

/* p (nq,) <- state of `to` with the poses of the start of `from`; poses and scratch are those of this one. */
static void copy_start(const zd_block *from, const zd_block *to, double *p, double *poses, double *scratch)
{
    const zd_system *system = zd_block_system(to);
    zd_block_poses(from, zd_block_start(from), poses, scratch);
    to->layout.of->state(to, poses, p);
    if (system->follow) system->follow(system->data, p);
}

void zd_block_explain_start(const zd_block *block, char *message, int message_size)
{
    zd_block *other = for_gaps(block);
    if (!other) return;
    const zd_system *system = zd_block_system(other);
    const int poses = zd_block_bodies(block) * zd_block_poses(block, NULL, NULL, NULL);
    const int is_few = system->nv <= MAX_DENSE && system->mh <= MAX_DENSE;
    double *p = is_few ? zd_allocate((system->nq + poses + zd_block_system(block)->scratch) * sizeof *p) : NULL;
    if (p) {
        copy_start(block, other, p, p + system->nq, p + system->nq + poses);
        find(other, p, 0, CLOSED * zd_block_length(block), (zd_complaint){message, message_size});
    }
    zd_release(p);
    zd_block_free(other);
}
