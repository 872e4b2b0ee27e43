/* Refuses what a system brings besides its terms where that is malformed, with a sentence. */
#ifndef ZD_INTERFACE_H
#define ZD_INTERFACE_H

#include "../zerodrift.h"

enum { ZD_LARGEST_PACKED = 0x100000 };  /* the same of systems that declare their structure */
enum { ZD_LARGEST = 8192 };     /* coordinates and velocities: with more, the sizes of matrices would leave the range of int */

/* The sizes and terms of the system have been checked before. */
int zd_check_interface(const zd_system *system, char *message, int size);

#endif
