#include "system.h"

#include "../bodies.h"

#define MECHANISM zd_space
#define OF(name) zd_space_##name
#define BODIES(self) (self)->bodies

ZD_INLINE zd_space_wrench weight(const zd_space *self, int body)
{
    return (zd_space_wrench){zd_times3(self->body[body].mass, self->gravity), {0, 0, 0}};
}

ZD_INLINE double weight_potential(const zd_space *self, const zd_space_frame *frame, int body)
{
    return self->body[body].mass * zd_inner3(self->gravity, frame->pose[body].at);
}

#include "../../common/forces_of_dimension.h"
