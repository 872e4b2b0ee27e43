/* The generalized force of a wrench on a body is its product with the column of each velocity, the twist of the body at unit velocity; the
 * wrench is then transmitted to the parent. */
#include "links.h"

#include "../../linalg/small.h"

static double work(zd_space_wrench what, const zd_space_twist *by)
{
    return zd_inner3(what.force, by->speed) + zd_inner3(what.torque, by->spin);
}

zd_space_wrench zd_space_tree_pass(const zd_space_link *link, const zd_space_pose *pose, int body, zd_space_wrench what)
{
    const zd_vector3 arm = zd_minus3(pose[body].at, pose[link->inner].at), moment = zd_cross3(arm, what.force);
    return (zd_space_wrench){what.force, link->turns ? zd_plus3(what.torque, moment) : moment};
}

/* A body with a wrench on it, on the way inward. */
typedef struct carried {
    int body;
    zd_space_wrench what;
    int start, is_complete;    /* `is_complete`: 1 while no particle on the way to the ground has blocked a torque */
} carried;

static void step_inward(const zd_space_tree *tree, const zd_space_frame *frame, double scale, carried *on, double *row)
{
    const zd_space_twist *column = zd_space_tree_frame_of(tree, frame).column;
    const zd_space_link *link = tree->link + on->body;
    for (int k = link->v; k < link->v + link->nv; k++) row[k] += scale * work(on->what, column + k);
    on->is_complete &= link->turns || on->body == on->start;
    on->what = zd_space_tree_pass(link, frame->pose, on->body, on->what);
    on->body = link->inner;
}

void zd_space_tree_act(const zd_space *space, const zd_space_frame *frame, const zd_space_quantity *quantity, double scale,
                       const zd_space_reading *reading,
                  double *row)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const int is_mutual = zd_space_quantity_is_mutual(quantity);
    const int first = is_mutual ? quantity->first : 0;
    carried one = {first, reading->first, first, 1}, other = {quantity->second, reading->second, quantity->second, 1};
    while (one.body != other.body) step_inward(tree, frame, scale, tree->link[one.body].depth > tree->link[other.body].depth ? &one : &other,
                                               row);
    if (one.is_complete && other.is_complete) return;
    zd_space_add_wrench(&one.what, 1, other.what);
    while (one.body) step_inward(tree, frame, scale, &one, row);
}

void zd_space_tree_gather(const zd_space *space, const zd_space_frame *frame, double *to)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const zd_space_twist *column = zd_space_tree_frame_of(tree, frame).column;
    zd_clear(tree->nv, to);
    for (int i = tree->bodies - 1; i >= 0; i--) {
        const int body = tree->order[i];
        const zd_space_link *link = tree->link + body;
        for (int k = link->v; k < link->v + link->nv; k++) to[k] = work(frame->wrench[body], column + k);
        zd_space_add_wrench(frame->wrench + link->inner, 1, zd_space_tree_pass(link, frame->pose, body, frame->wrench[body]));
    }
}

void zd_space_tree_transmit(const zd_space *space, const zd_space_frame *frame)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    for (int i = tree->bodies - 1; i >= 0; i--) {
        const int body = tree->order[i];
        const zd_space_link *link = tree->link + body;
        if (link->is_free) continue;
        zd_space_add_wrench(frame->wrench + link->inner, 1, zd_space_tree_pass(link, frame->pose, body, frame->wrench[body]));
    }
}
