/* Joints of a mechanism that cannot close, in one sentence, for Python and for pages. Plain declarations only: CFFI parses this text. */
#ifndef ZD_BLOCK_GAPS_H
#define ZD_BLOCK_GAPS_H

#include "block.h"

/* Sentence on the smallest gaps of the joints that are found from p (nq,) on, or if `is_smallest` on those at p. In the plane the former
 * names the loop that taken alone stays open most; if each can close alone, and otherwise, the three joints with the largest gaps are named.
 * Returns ZD_DONE, a status of the core, or ZD_BAD_ARGUMENT for a block without names. */
int zd_block_explain_gaps(const zd_block *block, const double *p, int is_smallest, char *message, int message_size);
/* The same from the block's start on, for any coordinates. `message` stays as it is if all joints can close. */
void zd_block_explain_start(const zd_block *block, char *message, int message_size);

#endif
