/* Checks of the optional members of zd_system; a failed check writes one sentence. */
#ifndef ZD_INTERFACE_H
#define ZD_INTERFACE_H

#include "../../zerodrift.h"

enum { ZD_LARGEST_PACKED = 0x100000 };  /* the same for systems that declare their structure */
enum { ZD_LARGEST = 8192 };     /* maximum number of coordinates, and of velocities: sizes of dense matrices must fit an int */

/* Sizes and terms of the system must be checked before. */
int zd_check_interface(const zd_system *system, char *message, int size);

#endif
