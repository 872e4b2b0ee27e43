/* Constraints and access of a mechanism, one text for the plane and for space: compiled once by a source of each, which defines MECHANISM,
 * its type; OF(name), a name of its dimension; and add_joint_row(). */

/* Rows of all joints outside the tree, and of relations, if they are nonholonomic or not. */
static void plan_constraints(const OF(tables) *tables, int nonholonomic, parts *to)
{
    for (int j = 0; j < tables->joints; j++) {
        const OF(joint_kind) *kind = OF(joint_kind_of)(to->joint[j].kind);
        if (to->planned[j].carried) continue;
        for (int i = 0; i < kind->rows; i++)
            if (kind->row[i].nonholonomic == nonholonomic) add_joint_row(to, j, i);
    }
    zd_elements_add_relations(&tables->elements, nonholonomic, &to->elements);
}

const zd_system *OF(system)(const MECHANISM *self) { return &self->system; }
const zd_constraint_owner *OF(rows)(const MECHANISM *self) { return self->elements.owner_of_constraint; }
int OF(data_size)(void) { return (int)sizeof(MECHANISM); }

void OF(with)(const MECHANISM *self, void *owner, const zd_law_program *program, const double *numbers, void *data)
{
    MECHANISM *mine = data;
    *mine = *self;
    mine->elements.owner = owner;
    mine->elements.program = program;
    mine->numbers = numbers;
}
