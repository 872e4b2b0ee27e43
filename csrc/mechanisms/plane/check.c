#include "tables.h"

#include "../common/check.h"

#define OF(name) zd_plane_##name
#define COMPONENTS 2
#define INERTIAS 1
#define QUANTITIES ZD_PLANE_QUANTITIES
#define LACKS "angle"

static const double *inertia_of(const zd_plane_body *body) { return &body->inertia; }
static int may_be_inboard(const zd_plane_joint_kind *kind, const zd_plane_joint *joint)
{
    (void)joint;
    return kind->inboard != ZD_NOT_INBOARD;
}

/* True if the joint turns about its point; `side` is of space. */
static int swings(const zd_plane_joint_kind *kind, int side)
{
    (void)side;
    return kind->inboard == ZD_TURNS;
}

static int may_join_itself(const zd_plane_joint_kind *kind) { return kind->row[0].nonholonomic; }

/* Angles are not counted. */
static int count_is_right(const zd_plane_tables *tables, int i, zd_complaint to)
{
    (void)tables, (void)i, (void)to;
    return 1;
}

#include "../common/check_of_dimension.h"
