/* Checks of bodies, joints and marker quantities, one text for the plane and for space: compiled once by a source of each, which defines
 * OF(name), a name of its dimension; COMPONENTS of a point; INERTIAS and inertia_of() of a body; QUANTITIES, the number of kinds; LACKS, what
 * a particle does not have; may_be_inboard() of a joint, swings() and may_join_itself() of its kind; count_is_right() of a quantity. */
static int is_particle(const OF(tables) *tables, int body) { return body && tables->body[body - 1].is_particle; }

static int inboard_is_right(const OF(tables) *tables, int i, zd_complaint to)
{
    const int inboard = tables->body[i].inboard, body = i + 1;
    if (inboard == -1) return 1;
    if (!zd_inboard_exists(body, inboard, tables->joints, to)) return 0;
    const OF(joint) *joint = tables->joint + inboard;
    const OF(joint_kind) *kind = OF(joint_kind_of)(joint->kind);
    if (!zd_inboard_connects(body, inboard, joint->first, joint->second, to)) return 0;
    if (!may_be_inboard(kind, joint))
        return zd_complain(to, "body %d: its inboard joint %d must be of a kind for trees, not a %s", body, inboard, kind->card.name);
    if ((is_particle(tables, joint->first) && !swings(kind, 0)) || (is_particle(tables, joint->second) && !swings(kind, 1)))
        return zd_complain(to, "body %d: its inboard joint %d must not be a %s, as a particle has no " LACKS, body, inboard, kind->card.name);
    for (int other = 0; other < i; other++)
        if (tables->body[other].inboard == inboard)
            return zd_complain(to, "joint %d must be the inboard joint of one body, not of bodies %d and %d", inboard, other + 1, body);
    return 1;
}

static int body_is_right(const void *all, int i, zd_complaint to)
{
    const OF(tables) *tables = all;
    const OF(body) *body = tables->body + i;
    if (!zd_mass_is_right(i + 1, body->mass, to)) return 0;
    for (int k = 0; k < INERTIAS; k++)
        if (!zd_inertia_is_right(i + 1, inertia_of(body)[k], body->is_particle, to)) return 0;
    return inboard_is_right(tables, i, to);
}

/* A particle has no axes: its point is its place. */
static int suits_particle(const OF(tables) *tables, int body, const double *point)
{
    int is_centre = 1;
    for (int k = 0; k < COMPONENTS; k++) is_centre &= point[k] == 0;
    return is_centre || !is_particle(tables, body);
}

static int joint_is_right(const void *all, int i, zd_complaint to)
{
    const OF(tables) *tables = all;
    const OF(joint) *joint = tables->joint + i;
    const OF(joint_kind) *kind = OF(joint_kind_of)(joint->kind);
    if (!kind) return zd_complain(to, "joint %d: its kind must be from 0 to %d, not %d", i, OF(joint_kinds)() - 1, joint->kind);
    if (!zd_bodies_are_right("joint", i, joint->first, joint->second, tables->bodies, to)) return 0;
    if (joint->first == joint->second && !may_join_itself(kind))
        return zd_complain(to, "joint %d: its bodies must differ, and both are %d", i, joint->first);
    return (suits_particle(tables, joint->first, joint->point1) && suits_particle(tables, joint->second, joint->point2)) ||
           zd_complain(to, "joint %d: its point on a particle must be the mass centre", i);
}

static int quantity_is_right(const void *all, int i, zd_complaint to)
{
    const OF(tables) *tables = all;
    const OF(quantity) *quantity = tables->quantity + i;
    if (!zd_is_in(quantity->kind, QUANTITIES))
        return zd_complain(to, "marker quantity %d: its kind must be from 0 to %d, not %d", i, QUANTITIES - 1, quantity->kind);
    if (!zd_bodies_are_right("marker quantity", i, quantity->first, quantity->second, tables->bodies, to)) return 0;
    if (!count_is_right(tables, i, to)) return 0;
    return (suits_particle(tables, quantity->first, quantity->point1) && suits_particle(tables, quantity->second, quantity->point2)) ||
           zd_complain(to, "marker quantity %d: its point on a particle must be the mass centre", i);
}

int OF(tables_are_right)(const OF(tables) *tables, char *message, int message_size)
{
    const zd_complaint to = {message, message_size};
    const zd_checked all[] = {     /* joints before the bodies whose inboard joints they are */
        {tables->joints, joint_is_right}, {tables->bodies, body_is_right}, {tables->quantities, quantity_is_right}};
    const int arrays = sizeof all / sizeof all[0];
    return zd_mechanism_is_right(tables, tables->bodies, arrays, all, &tables->elements, tables->joints, tables->quantities, to);
}
