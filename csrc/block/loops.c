#include "made.h"

#include <string.h>

/* Members of entries: kind, first and second body begin those of joints, mass those of bodies, and is_particle and inboard end these. */
static int end_of(const zd_block_layout *layout, int joint, int side)
{
    return (int)zd_block_entry(layout, ZD_BLOCK_JOINTS, joint)[1 + side];
}

static int from_end(const zd_block_layout *layout, int body, int member)
{
    return (int)zd_block_entry(layout, ZD_BLOCK_BODIES, body)[-member];      /* before the entry of the next body */
}

static int is_particle(const zd_block_layout *layout, int body) { return from_end(layout, body, 2); }
int zd_block_inboard(const zd_block_layout *layout, int body) { return from_end(layout, body, 1); }
static double mass_of(const zd_block_layout *layout, int body) { return *zd_block_entry(layout, ZD_BLOCK_BODIES, body - 1); }

int zd_block_has_tree(const zd_block_layout *layout)
{
    for (int body = 1; body <= zd_block_count(layout, ZD_BLOCK_BODIES); body++)
        if (zd_block_inboard(layout, body) >= 0) return 1;
    return 0;
}

/* ---- tree ---- */

/* Heaviest body that the tree has not reached, particles last; 0: there is none. */
static int next_root(const zd_block_layout *layout, const int *distance)
{
    int root = 0;
    for (int body = 1; body <= zd_block_count(layout, ZD_BLOCK_BODIES); body++) {
        if (distance[body] >= 0) continue;
        const int later = root ? is_particle(layout, body) - is_particle(layout, root) : -1;
        if (later < 0 || (!later && mass_of(layout, body) > mass_of(layout, root))) root = body;
    }
    return root;
}

/* Next inboard joint, and the body that it carries; -1: no joint leads further. */
static int next_inboard(const zd_block_layout *layout, const int *distance, int *carried)
{
    int best = -1, least = 0, nearest = 0;
    for (int joint = 0; joint < zd_block_count(layout, ZD_BLOCK_JOINTS); joint++) {
        for (int side = 0; side < 2; side++) {
            const int inner = end_of(layout, joint, 1 - side), outer = end_of(layout, joint, side);
            if (distance[inner] < 0 || distance[outer] >= 0) continue;
            const int freedoms = layout->of->freedoms(layout, joint, is_particle(layout, outer));
            if (freedoms < 0 || (best >= 0 && (freedoms > least || (freedoms == least && distance[inner] >= nearest)))) continue;
            best = joint, least = freedoms, nearest = distance[inner], *carried = outer;
        }
    }
    return best;
}

void zd_block_grow_tree(const zd_block_layout *layout, int *inboard, int *distance)
{
    const int bodies = zd_block_count(layout, ZD_BLOCK_BODIES);
    for (int body = 0; body <= bodies; body++) distance[body] = body ? -1 : 0;
    for (int reached = 0; reached < bodies; reached++) {
        int body, joint = next_inboard(layout, distance, &body);
        if (joint < 0) body = next_root(layout, distance);
        const int side = joint >= 0 && end_of(layout, joint, 0) == body;
        distance[body] = joint < 0 ? 0 : distance[end_of(layout, joint, side)] + 1;
        inboard[body - 1] = joint;
    }
}

/* ---- loops ---- */

/* Name of a body, from 1, or of the ground */
static const char *body_name(const zd_block_layout *layout, int body)
{
    return body ? zd_block_text(layout, *zd_block_entry(layout, ZD_BLOCK_NAMES, body - 1)) : "ground";
}

const char *zd_block_joint_name(const zd_block_layout *layout, int joint)
{
    return zd_block_text(layout, *zd_block_entry(layout, ZD_BLOCK_NAMES, zd_block_count(layout, ZD_BLOCK_BODIES) + joint));
}

/* Body to which a body is connected by its inboard joint; the ground for a free one. */
static int parent_of(const zd_block_layout *layout, int body)
{
    const int joint = zd_block_inboard(layout, body);
    return joint < 0 ? 0 : end_of(layout, joint, end_of(layout, joint, 0) == body);
}

/* Bodies from below `meet` out to a body, in this order or the opposite one; their inboard joints are of the loop. */
static void name_way(const zd_block_layout *layout, int body, int meet, int is_outward, int *of_loop, zd_complaint *to)
{
    if (body == meet) return;
    if (!is_outward) zd_append(to, ", %s", body_name(layout, body));
    if (zd_block_inboard(layout, body) >= 0) of_loop[zd_block_inboard(layout, body)] = 1;
    name_way(layout, parent_of(layout, body), meet, is_outward, of_loop, to);
    if (is_outward) zd_append(to, ", %s", body_name(layout, body));
}

void zd_block_name_loop(const zd_block_layout *layout, int joint, int *is_on_way, zd_complaint *to)
{
    const int bodies = zd_block_count(layout, ZD_BLOCK_BODIES), joints = zd_block_count(layout, ZD_BLOCK_JOINTS);
    int *of_loop = is_on_way + bodies + 1, meet = end_of(layout, joint, 1), is_first = 1;
    memset(is_on_way, 0, (bodies + 1 + joints) * sizeof *is_on_way);
    for (int body = end_of(layout, joint, 0); body; body = parent_of(layout, body)) is_on_way[body] = 1;
    while (meet && !is_on_way[meet]) meet = parent_of(layout, meet);
    of_loop[joint] = 1;
    zd_append(to, "the loop of %s", body_name(layout, meet));
    name_way(layout, end_of(layout, joint, 0), meet, 1, of_loop, to);
    name_way(layout, end_of(layout, joint, 1), meet, 0, of_loop, to);
    for (int i = 0; i < joints; i++) {
        if (!of_loop[i]) continue;
        zd_append(to, "%s%s", is_first ? ", through " : ", ", zd_block_joint_name(layout, i));
        is_first = 0;
    }
}
