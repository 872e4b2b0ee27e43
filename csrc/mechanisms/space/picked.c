/* Gauges of the entries of a joint's table. */
#include "picked.h"

#include <string.h>

static void copy3(const double *from, double *to)
{
    for (int k = 0; k < 3; k++) to[k] = from[k];
}

/* The sum of the directions of the second's frame, each times itself and the square of its semiaxis. */
static void write_shape(const zd_space_joint *joint, double shape[3][3])
{
    for (int d = 0; d < ZD_SPACE_AXES; d++)
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                shape[i][k] += joint->semiaxes[d] * joint->semiaxes[d] * joint->frame2[d][i] * joint->frame2[d][k];
}

/* A pick of the second body alone: the body then is both sides of its gauge. */
static zd_space_joint of_second(const zd_space_joint *joint)
{
    zd_space_joint own = *joint;
    own.first = joint->second;
    copy3(joint->point2, own.point1);
    memcpy(own.frame1, joint->frame2, sizeof own.frame1);
    return own;
}

/* The gauge that a pick of a joint's kind is. */
zd_space_gauge zd_space_picked_gauge(const zd_space_joint *joint, const zd_space_pick *pick)
{
    if (pick->is_own) {
        const zd_space_joint own = of_second(joint);
        const zd_space_pick alone = {pick->gauge, pick->of_first, pick->of_second, pick->zero, 0, 0};
        return zd_space_picked_gauge(&own, &alone);
    }
    const int rolls = zd_space_joint_kind_of(joint->kind)->rolls, swapped = pick->is_swapped;
    const int o = rolls ? ZD_SPACE_AXIS : (pick->of_first + (swapped ? ZD_SPACE_AXES - 1 : 1)) % ZD_SPACE_AXES;
    const double(*frame1)[3] = swapped ? joint->frame2 : joint->frame1, (*frame2)[3] = swapped ? joint->frame1 : joint->frame2;
    zd_space_gauge gauge = {.kind = (int)pick->gauge, .first = swapped ? joint->second : joint->first,
                            .second = swapped ? joint->first : joint->second};
    copy3(swapped ? joint->point2 : joint->point1, gauge.point1);
    copy3(swapped ? joint->point1 : joint->point2, gauge.point2);
    copy3(frame1[pick->of_first], gauge.a);
    copy3(frame1[o], gauge.o);
    copy3(frame2[pick->of_second], gauge.b);
    write_shape(joint, gauge.shape);
    gauge.zero = pick->zero == ZD_SPACE_ZERO_ALONG ? joint->along : pick->zero == ZD_SPACE_ZERO_LENGTH ? joint->length : 0;
    return gauge;
}

zd_space_gauge zd_space_coordinate_gauge(const zd_space_joint *joint, int coordinate, int angles)
{
    const zd_space_coordinate *coordinates = zd_space_joint_kind_of(joint->kind)->coordinate;
    zd_space_gauge gauge = zd_space_picked_gauge(joint, &coordinates[coordinate].pick);
    if (gauge.kind != ZD_SPACE_ANGLE) return gauge;
    gauge.counted = angles + 1;
    for (int i = 0; i < coordinate; i++) gauge.counted += coordinates[i].pick.gauge == ZD_SPACE_ANGLE;
    return gauge;
}
