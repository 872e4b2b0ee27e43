#include "system.h"

#include "../tree.h"

#define MECHANISM zd_plane
#define OF(name) zd_plane_##name

ZD_INLINE zd_plane_wrench weight(const zd_plane *self, int body)
{
    return (zd_plane_wrench){zd_times(MASS(self, body), self->gravity), 0};
}

ZD_INLINE double weight_potential(const zd_plane *self, const zd_plane_frame *frame, int body)
{
    return MASS(self, body) * zd_inner(self->gravity, frame->pose[body].at);
}

#include "../../common/forces_of_dimension.h"
