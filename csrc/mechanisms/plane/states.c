/* Between poses of bodies and coordinates. */
#include "plan.h"
#include "tree.h"

void zd_plane_poses(const zd_plane *mechanism, const double *p, const double *v, double *poses, double *rates, double *scratch)
{
    const zd_plane_tree *tree = &mechanism->tree;
    zd_plane_frame frame;
    zd_plane_frame_of(mechanism, scratch, &frame);
    zd_plane_tree_turn(tree, p, frame.sines);
    zd_plane_tree_place(tree, p, frame.sines, frame.pose);
    if (v) zd_plane_tree_move(tree, frame.pose, v, frame.twist);
    for (int body = 1; body <= tree->bodies; body++) {
        const zd_plane_pose *pose = frame.pose + mechanism->number[body];
        double *to = poses + 3 * (body - 1);
        to[0] = pose->at.x;
        to[1] = pose->at.y;
        to[2] = pose->angle;
        if (!v) continue;
        const zd_plane_twist *twist = frame.twist + mechanism->number[body];
        to = rates + 3 * (body - 1);
        to[0] = twist->speed.x;
        to[1] = twist->speed.y;
        to[2] = twist->turn;
    }
}

static zd_plane_pose given_pose(const double *pose, int body)
{
    if (!body) return (zd_plane_pose){.cosine = 1};
    const double *x = pose + 3 * (body - 1);
    return (zd_plane_pose){.at = {x[0], x[1]}, .angle = x[2], .cosine = cos(x[2]), .sine = sin(x[2])};
}

static zd_plane_twist given_twist(const double *rates, int body)
{
    if (!body) return (zd_plane_twist){.turn = 0};
    const double *x = rates + 3 * (body - 1);
    return (zd_plane_twist){.speed = {x[0], x[1]}, .turn = x[2]};
}

/* The displacement of a joint, or its rate, from the poses of its bodies. */
static double slide(const zd_plane *mechanism, const double *poses, const double *rates, const zd_plane_coordinate_owner *coordinate)
{
    const zd_plane_joint *joint = NULL;
    for (int j = 0; j < mechanism->joints && !joint; j++)
        if (mechanism->planned[j].carried == mechanism->number[coordinate->body]) joint = mechanism->joint + j;
    int first = 0, second = 0;
    for (int body = 1; body <= mechanism->tree.bodies; body++) {
        if (mechanism->number[body] == joint->first) first = body;
        if (mechanism->number[body] == joint->second) second = body;
    }
    const zd_plane_pose pose[] = {given_pose(poses, first), given_pose(poses, second)};
    const zd_plane_quantity quantity = {ZD_PLANE_ALONG, 0, 1, {joint->point1[0], joint->point1[1]}, {joint->point2[0], joint->point2[1]},
                            {joint->axis[0], joint->axis[1]}, joint->along};
    if (!rates) return zd_plane_quantity_read(&quantity, pose).value;
    const zd_plane_twist twist[] = {given_twist(rates, first), given_twist(rates, second)};
    double bias;
    return zd_plane_quantity_rate(&quantity, pose, twist, &bias);
}

void zd_plane_state(const zd_plane *mechanism, const double *poses, const double *rates, double *p, double *v)
{
    for (int i = 0; i < mechanism->system.nq; i++) {
        const zd_plane_coordinate_owner *coordinate = mechanism->coordinate + i;
        int from = 3 * (coordinate->body - 1) + (int)coordinate->kind;
        int slides = coordinate->kind == ZD_COORDINATE_DISPLACEMENT;
        p[i] = slides ? slide(mechanism, poses, NULL, coordinate) : poses[from];
        if (rates) v[i] = slides ? slide(mechanism, poses, rates, coordinate) : rates[from];
    }
}
