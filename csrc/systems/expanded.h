/* A system with dense matrices in place of one that declares its structure. */
#ifndef ZD_EXPANDED_H
#define ZD_EXPANDED_H

#include "../zerodrift.h"

/* It refers to `inner`; what belongs to the structure, and what has to be told of the inner system's own data, is left out. */
zd_system zd_expanded(const zd_system *inner);

#endif
