/* A wrench on a body does to each velocity its product with the column, which is the twist of that body by this velocity; then it goes on
 * to the body that this one hangs on. */
#include "inward.h"

#include <string.h>

static double work(zd_wrench3 what, const zd_twist3 *by)
{
    return zd_inner3(what.force, by->speed) + zd_inner3(what.torque, by->spin);
}

zd_wrench3 zd_tree3_pass(const zd_link3 *link, const zd_pose3 *pose, int body, zd_wrench3 what)
{
    const zd_vector3 arm = zd_minus3(pose[body].at, pose[link->inner].at), moment = zd_cross3(arm, what.force);
    return (zd_wrench3){what.force, link->turns ? zd_plus3(what.torque, moment) : moment};
}

/* A body with a wrench on it, on the way inward. */
typedef struct carried {
    int body;
    zd_wrench3 what;
    int start, is_whole;    /* whether no particle on the way has kept a torque back */
} carried;

static void step_inward(const zd_tree3 *tree, const zd_frame3 *frame, double scale, carried *on, double *row)
{
    const zd_twist3 *column = zd_tree_frame3_of(tree, frame).column;
    const zd_link3 *link = tree->link + on->body;
    for (int k = link->v; k < link->v + link->nv; k++) row[k] += scale * work(on->what, column + k);
    on->is_whole &= link->turns || on->body == on->start;
    on->what = zd_tree3_pass(link, frame->pose, on->body, on->what);
    on->body = link->inner;
}

void zd_tree3_act(const zd_space *space, const zd_frame3 *frame, const zd_space_gauge *gauge, double scale, const zd_reading3 *reading,
                  double *row)
{
    const zd_tree3 *tree = zd_tree3_of(space);
    const int is_mutual = zd_space_gauge_is_mutual(gauge);
    const int first = is_mutual ? gauge->first : 0;
    carried one = {first, reading->first, first, 1}, other = {gauge->second, reading->second, gauge->second, 1};
    while (one.body != other.body) step_inward(tree, frame, scale, tree->link[one.body].depth > tree->link[other.body].depth ? &one : &other, row);
    if (one.is_whole && other.is_whole) return;
    zd_add_wrench3(&one.what, 1, other.what);
    while (one.body) step_inward(tree, frame, scale, &one, row);
}

void zd_tree3_gather(const zd_space *space, const zd_frame3 *frame, double *to)
{
    const zd_tree3 *tree = zd_tree3_of(space);
    const zd_twist3 *column = zd_tree_frame3_of(tree, frame).column;
    memset(to, 0, (size_t)tree->nv * sizeof *to);
    for (int i = tree->bodies - 1; i >= 0; i--) {
        const int body = tree->order[i];
        const zd_link3 *link = tree->link + body;
        for (int k = link->v; k < link->v + link->nv; k++) to[k] = work(frame->wrench[body], column + k);
        zd_add_wrench3(frame->wrench + link->inner, 1, zd_tree3_pass(link, frame->pose, body, frame->wrench[body]));
    }
}

void zd_tree3_transmit(const zd_space *space, const zd_frame3 *frame)
{
    const zd_tree3 *tree = zd_tree3_of(space);
    for (int i = tree->bodies - 1; i >= 0; i--) {
        const int body = tree->order[i];
        const zd_link3 *link = tree->link + body;
        if (link->is_free) continue;
        zd_add_wrench3(frame->wrench + link->inner, 1, zd_tree3_pass(link, frame->pose, body, frame->wrench[body]));
    }
}
