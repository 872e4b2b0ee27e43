/* What goes through a joint of the tree is what the bodies further out need for their accelerations beyond what else acts on them. */
#include "reactions.h"

#include "../gauges/laws.h"
#include "../space/efforts.h"
#include "../space/gauge.h"
#include "inertia.h"
#include "inward.h"
#include "motion.h"

/* frame->wrench += what a row does to bodies, `scale` times */
static void add_row(const zd_space *space, const zd_frame3 *frame, const zd_relation *row, const double *factors, double scale)
{
    for (int i = 0; i < row->terms; i++) {
        const zd_space_gauge *gauge = space->gauge + space->elements.term[row->first + i].gauge;
        const zd_reading3 reading = zd_space_gauge_read(gauge, frame->pose);
        zd_add_wrench3(frame->wrench + gauge->first, scale * factors[i], reading.first);
        zd_add_wrench3(frame->wrench + gauge->second, scale * factors[i], reading.second);
    }
}

/* frame->wrench <- what each body needs beyond what acts on it, but for joints of the tree. */
static int write_needs(const zd_space *space, const zd_frame3 *frame, double t, const double *vdot, const double *lambda)
{
    const zd_readings readings = zd_frame3_readings(space, frame);
    if (zd_space_efforts_apply(space, frame, t)) return ZD_CALLBACK;
    for (int i = 0; i < space->elements.m; i++) {
        zd_combined all;
        if (zd_combine(&space->elements, &readings, space->elements.row + i, t, &all)) return ZD_CALLBACK;
        add_row(space, frame, space->elements.row + i, all.factors, -lambda[i]);
    }
    zd_tree3_accelerate(space, frame, vdot);
    const zd_twist3 *change = zd_tree_frame3_of(zd_tree3_of(space), frame).change;
    for (int body = 1; body <= space->bodies; body++) {
        zd_wrench3 need = zd_tree3_need(space->body + body, frame->pose + body, frame->twist + body, change + body);
        zd_add_wrench3(&need, -1, frame->wrench[body]);
        frame->wrench[body] = need;
    }
    return ZD_DONE;
}

static zd_vector3 across(zd_vector3 a, zd_vector3 e) { return zd_minus3(a, zd_times3(zd_inner3(a, e), e)); }

/* Along its own freedoms a joint does nothing; what is left there is rounding. */
static zd_wrench3 without_freedoms(const zd_link3 *link, const zd_twist3 *column, zd_wrench3 through)
{
    for (const zd_freedom3 *freedom = link->freedom; freedom < link->freedom + link->freedoms; freedom++) {
        const zd_twist3 *own = column + freedom->v;
        if (freedom->kind == ZD_SPACE_SLIDES) through.force = across(through.force, own->speed);
        if (freedom->kind == ZD_SPACE_TURNS) through.torque = across(through.torque, own->spin);
        if (freedom->kind == ZD_SPACE_SWINGS) through.torque = (zd_vector3){0, 0, 0};
    }
    if (!link->turns) through.torque = (zd_vector3){0, 0, 0};
    return through;
}

int zd_tree3_reaction(const zd_space *space, const zd_frame3 *frame, int joint, zd_vector3 point, double t, const double *vdot,
                      const double *lambda, zd_wrench3 *reaction)
{
    const zd_tree3 *tree = zd_tree3_of(space);
    const int carried = space->planned[joint].carried;
    if (write_needs(space, frame, t, vdot, lambda)) return ZD_CALLBACK;
    zd_tree3_transmit(space, frame);
    zd_wrench3 through = frame->wrench[carried];
    through.torque = zd_plus3(through.torque, zd_cross3(zd_minus3(frame->pose[carried].at, point), through.force));
    zd_add_wrench3(reaction, space->planned[joint].sign,
                   without_freedoms(tree->link + carried, zd_tree_frame3_of(tree, frame).column, through));
    return ZD_DONE;
}
