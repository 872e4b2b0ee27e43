/* Reaction of a joint, one text for the plane and for space: compiled once by a source of each, which defines MECHANISM, its type;
 * OF(name), a name of its dimension; VECTOR, a type; point_of() of a joint; about(), which moves the torque of a wrench from a body's mass
 * centre to a point; and through_tree(), which adds the wrench of an inboard joint. */

/* Reaction of a joint on its second body, about a point of it. */
typedef struct reaction_at {
    int body;
    VECTOR point;
    OF(wrench) *reaction;
} reaction_at;

/* The joint's second body is either one of the marker quantity's. */
static void add_quantity(const zd_readings *at, void *to, int index, double force)
{
    const OF(quantity) *quantity = ((const MECHANISM *)at->mechanism)->quantity + index;
    const OF(pose) *pose = ((const OF(frame) *)at->frame)->pose;
    const reaction_at *of = to;
    const OF(reading) reading = OF(quantity_read)(quantity, pose);
    OF(add_wrench)(of->reaction, force, about(quantity->second == of->body ? reading.second : reading.first, pose + of->body, of->point));
}

int OF(joint_reaction)(const MECHANISM *self, const OF(frame) *frame, int joint, const zd_measured_state *at, OF(wrench) *reaction)
{
    const OF(planned_joint) *planned = self->planned + joint;
    reaction_at to = {self->joint[joint].second, point_of(self, frame, joint), reaction};
    const zd_readings readings = OF(frame_readings)(self, frame);
    const zd_actions actions = {&self->elements, &readings, add_quantity, &to};
    int status = ZD_DONE;
    *reaction = (OF(wrench)){.force = {0}};
    if (planned->carried) status = through_tree(self, frame, joint, to.point, at, reaction);
    else zd_joint_rows_act(&actions, planned->row_count, planned->rows, at->lambda);
    return status ? status : zd_drives_act(&actions, joint, at);
}
