/* Numerics of measures in space: see ../../common/output_spec.h. */
#include "system.h"

#include "../../../linalg/small.h"
#include "../../common/output_spec.h"
#include "../bodies.h"

#define MECHANISM zd_space
#define OF(name) zd_space_##name
#define FORCES 3
#define TORQUES 3
#define VELOCITIES ZD_BODY_VELOCITIES
#define MINUS zd_minus3
#define POINT_OF zd_space_point_of

static void place(const void *mechanism, const void *frame, const double *p) { zd_space_frame_place(mechanism, frame, p); }

static void move(const void *mechanism, const void *frame, const double *v) { zd_space_frame_move(mechanism, frame, v); }

static void write_row(const void *mechanism, const void *frame, int index, double scale, double *row, double *value)
{
    const zd_space *self = mechanism;
    const zd_space_frame *at = frame;
    const zd_space_quantity *quantity = self->quantity + index;
    const zd_space_reading reading = (value ? zd_space_quantity_read : zd_space_quantity_wrenches)(quantity, at->pose);
    if (value) *value = zd_space_quantity_counted(quantity, reading.value, at->angle);
    zd_clear(self->system.nv, row);
    if (self->carrying.act) {
        self->carrying.act(self, at, quantity, scale, &reading, row);
        return;
    }
    const struct {
        int body;
        zd_space_wrench wrench;
    } sides[] = {{quantity->first, reading.first}, {quantity->second, reading.second}};
    for (int i = 0; i < 2; i++) {
        const int body = sides[i].body;
        if (body) zd_body_act(self->body + body, at->pose + body, scale, sides[i].wrench, row + self->body[body].v);
    }
}

static void write_vector(zd_vector3 what, double *to)
{
    to[0] = what.x, to[1] = what.y, to[2] = what.z;
}

static void write_wrench(zd_space_wrench from, double *to)
{
    write_vector(from.force, to);
    write_vector(from.torque, to + ZD_WRENCH_FORCE);
}

static int act_on_body(const zd_space *self, const zd_space_frame *frame, int body, double scale, zd_space_wrench what, double *own)
{
    memset(own, 0, VELOCITIES * sizeof *own);
    if (!body) return -1;
    zd_body_act(self->body + body, frame->pose + body, scale, what, own);
    return self->body[body].v;
}

#include "../../common/measures_of_dimension.h"
