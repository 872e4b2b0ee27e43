/* Reaction of an inboard joint: inertia forces of the outer bodies minus all other forces on them. */
#include "links.h"

#include "../space/system/system.h"

/* frame->wrench <- inertia force of each body minus the applied and constraint forces on it, without joints of the tree. */
static int write_needs(const zd_space *space, const zd_space_frame *frame, const zd_measured_state *at)
{
    const zd_readings readings = zd_space_frame_readings(space, frame);
    const zd_actions actions = {&space->elements, &readings, zd_space_add_force, NULL};
    if (!at->vdot) memset(frame->wrench, 0, (space->bodies + 1) * sizeof *frame->wrench);
    else if (zd_space_forces_apply(space, frame, at->t)) return ZD_CALLBACK;
    if (zd_rows_act(&actions, at)) return ZD_CALLBACK;
    if (at->vdot) zd_space_tree_accelerate(space, frame, at->vdot);
    const zd_space_twist *change = zd_space_tree_frame_of(zd_space_tree_of(space), frame).change;
    for (int body = 1; body <= space->bodies; body++) {
        zd_space_wrench need = {{0, 0, 0}, {0, 0, 0}};
        if (at->vdot) need = zd_space_tree_need(space->body + body, frame->pose + body, frame->twist + body, change + body);
        zd_space_add_wrench(&need, -1, frame->wrench[body]);
        frame->wrench[body] = need;
    }
    return ZD_DONE;
}

static zd_vector3 across(zd_vector3 a, zd_vector3 e) { return zd_minus3(a, zd_times3(zd_inner3(a, e), e)); }

/* Along its own freedoms a joint does nothing; what is left there is rounding. */
static zd_space_wrench without_freedoms(const zd_space_link *link, const zd_space_twist *column, zd_space_wrench through)
{
    for (const zd_space_link_freedom *freedom = link->freedom; freedom < link->freedom + link->freedoms; freedom++) {
        const zd_space_twist *own = column + freedom->v;
        if (freedom->kind == ZD_SPACE_SLIDES) through.force = across(through.force, own->speed);
        if (freedom->kind == ZD_SPACE_TURNS) through.torque = across(through.torque, own->spin);
        if (freedom->kind == ZD_SPACE_SWINGS) through.torque = (zd_vector3){0, 0, 0};
    }
    if (!link->turns) through.torque = (zd_vector3){0, 0, 0};
    return through;
}

int zd_space_tree_reaction(const zd_space *space, const zd_space_frame *frame, int joint, zd_vector3 point, const zd_measured_state *at,
                           zd_space_wrench *reaction)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const int carried = space->planned[joint].carried;
    if (write_needs(space, frame, at)) return ZD_CALLBACK;
    zd_space_tree_transmit(space, frame);
    zd_space_wrench through = frame->wrench[carried];
    through.torque = zd_plus3(through.torque, zd_cross3(zd_minus3(frame->pose[carried].at, point), through.force));
    zd_space_add_wrench(reaction, space->planned[joint].sign,
                   without_freedoms(tree->link + carried, zd_space_tree_frame_of(tree, frame).column, through));
    return ZD_DONE;
}
