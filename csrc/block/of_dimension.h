/* One text for the plane and for space: compiled once by a source of each, which defines MECHANISM, its type, and OF(name), a name of its
 * dimension. */
/* Members of the tables. */
#define BODY(member, count) ZD_DOUBLES_FIELD(OF(body), member, count)
#define BODY_INT(member) ZD_INT_FIELD(OF(body), member)
#define JOINT(member, count) ZD_DOUBLES_FIELD(OF(joint), member, count)
#define JOINT_INT(member) ZD_INT_FIELD(OF(joint), member)
#define QUANTITY(member, count) ZD_DOUBLES_FIELD(OF(quantity), member, count)
#define QUANTITY_INT(member) ZD_INT_FIELD(OF(quantity), member)

static OF(tables) tables_of(const zd_block_layout *layout, void *const *section, const zd_elements *elements)
{
    OF(tables) tables = {
        .bodies = zd_block_count(layout, ZD_BLOCK_BODIES), .joints = zd_block_count(layout, ZD_BLOCK_JOINTS),
        .quantities = zd_block_count(layout, ZD_BLOCK_QUANTITIES), .body = section[ZD_BLOCK_BODIES], .joint = section[ZD_BLOCK_JOINTS],
        .quantity = section[ZD_BLOCK_QUANTITIES], .elements = *elements};
    memcpy(tables.gravity, layout->part[ZD_BLOCK_GRAVITY].word, sizeof tables.gravity);
    return tables;
}

/* The block has this mechanism; 0 if it is NULL. */
static int set_mechanism(zd_block *self, MECHANISM *made)
{
    self->mechanism = made;
    if (!made) return 0;
    self->force = (zd_generalized_force *)(uintptr_t)OF(planned)(made).force;
    self->names.owner = OF(rows)(made);
    self->system = *OF(system)(made);
    return 1;
}

static void release(void *mechanism) { OF(free)(mechanism); }
