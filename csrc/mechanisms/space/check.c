#include "tables.h"

#include "../common/check.h"
#include "plan.h"

#define OF(name) zd_space_##name
#define COMPONENTS 3
#define INERTIAS 3
#define QUANTITIES ZD_SPACE_QUANTITIES
#define LACKS "axes"

static const double *inertia_of(const zd_space_body *body) { return body->inertia; }
/* A universal joint whose axes are not perpendicular, of which `along` is the cosine, closes a loop. */
static int may_be_inboard(const zd_space_joint_kind *kind, const zd_space_joint *joint)
{
    return kind->is_inboard && (kind->axes < 2 || joint->along == 0);
}

/* True if the freedom next to the first or second body is a rotation about a point, which a particle, having no axes, cannot have. */
static int swings(const zd_space_joint_kind *kind, int side)
{
    return kind->freedoms && kind->freedom[side ? kind->freedoms - 1 : 0].kind == ZD_SPACE_SWINGS;
}

static int may_join_itself(const zd_space_joint_kind *kind)
{
    (void)kind;
    return 0;
}

/* A quantity may count the turns of an angle of a joint. */
static int count_is_right(const zd_space_tables *tables, int i, zd_complaint to)
{
    const zd_space_quantity *quantity = tables->quantity + i;
    int angles = 0;
    for (int k = 0; k < tables->joints; k++) angles += zd_unwrapped_angles_of(tables->joint + k);
    if (!quantity->counted || (quantity->kind == ZD_SPACE_ANGLE && zd_is_in(quantity->counted - 1, angles))) return 1;
    return zd_complain(to, "marker quantity %d: it must count the turns of an angle of a joint, not of angle %d", i, quantity->counted - 1);
}

#include "../common/check_of_dimension.h"
