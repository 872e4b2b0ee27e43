/* What is kept of a run: one row of the caller's arrays for each saved instant. */
#ifndef ZD_RECORD_H
#define ZD_RECORD_H

#include "../motion/motion.h"

/* Adds where the motion is. */
int zd_record_row(zd_motion *motion, zd_record *record);

#endif
