#include "system.h"

#include "../bodies.h"

#define MECHANISM zd_space
#define OF(name) zd_space_##name

ZD_INLINE zd_space_wrench weight(const zd_space *self, int body)
{
    return (zd_space_wrench){zd_times3(MASS(self, body), self->gravity), {0, 0, 0}};
}

ZD_INLINE double weight_potential(const zd_space *self, const zd_space_frame *frame, int body)
{
    return MASS(self, body) * zd_inner3(self->gravity, frame->pose[body].at);
}

#include "../../common/forces_of_dimension.h"
