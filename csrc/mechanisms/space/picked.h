/* The marker quantities of joints. */
#ifndef ZD_SPACE_PICKED_H
#define ZD_SPACE_PICKED_H

#include "tables.h"

/* The marker quantity that a pick of a joint's kind is; an angle counts no turns. */
zd_space_quantity zd_space_picked_quantity(const zd_space_joint *joint, const zd_space_pick *pick);

#endif
