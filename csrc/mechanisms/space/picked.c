/* Marker quantities of the entries of a joint's table. */
#include "plan.h"

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

/* A pick of the second body alone: the body then is both sides of its marker quantity. */
static zd_space_joint of_second(const zd_space_joint *joint)
{
    zd_space_joint own = *joint;
    own.first = joint->second;
    copy3(joint->point2, own.point1);
    memcpy(own.frame1, joint->frame2, sizeof own.frame1);
    return own;
}

/* The marker quantity that a pick of a joint's kind is. */
zd_space_quantity zd_space_picked_quantity(const zd_space_joint *joint, const zd_space_pick *pick)
{
    if (pick->is_own) {
        const zd_space_joint own = of_second(joint);
        const zd_space_pick alone = {pick->quantity, pick->of_first, pick->of_second, pick->zero, 0, 0};
        return zd_space_picked_quantity(&own, &alone);
    }
    const int rolls = zd_space_joint_kind_of(joint->kind)->rolls, swapped = pick->is_swapped;
    const int o = rolls ? ZD_SPACE_AXIS : (pick->of_first + (swapped ? ZD_SPACE_AXES - 1 : 1)) % ZD_SPACE_AXES;
    const double(*frame1)[3] = swapped ? joint->frame2 : joint->frame1, (*frame2)[3] = swapped ? joint->frame1 : joint->frame2;
    zd_space_quantity quantity = {.kind = (int)pick->quantity, .first = swapped ? joint->second : joint->first,
                            .second = swapped ? joint->first : joint->second};
    copy3(swapped ? joint->point2 : joint->point1, quantity.point1);
    copy3(swapped ? joint->point1 : joint->point2, quantity.point2);
    copy3(frame1[pick->of_first], quantity.a);
    copy3(frame1[o], quantity.o);
    copy3(frame2[pick->of_second], quantity.b);
    write_shape(joint, quantity.shape);
    if (rolls && zd_space_joint_kind_of(joint->kind)->takes_length) quantity.shape[0][0] = joint->length;
    quantity.zero = pick->zero == ZD_SPACE_ZERO_ALONG ? joint->along : pick->zero == ZD_SPACE_ZERO_LENGTH ? joint->length : 0;
    return quantity;
}

zd_space_quantity zd_space_coordinate_quantity(const zd_space_joint *joint, int coordinate, int angles)
{
    const zd_space_coordinate *coordinates = zd_space_joint_kind_of(joint->kind)->coordinate;
    zd_space_quantity quantity = zd_space_picked_quantity(joint, &coordinates[coordinate].pick);
    if (quantity.kind != ZD_SPACE_ANGLE) return quantity;
    quantity.counted = angles + 1;
    for (int i = 0; i < coordinate; i++) quantity.counted += coordinates[i].pick.quantity == ZD_SPACE_ANGLE;
    return quantity;
}
