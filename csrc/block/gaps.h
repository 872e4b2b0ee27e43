/* Joints of a mechanism that cannot close, in one sentence, for Python and for pages. Plain declarations only: CFFI parses this text. */
#ifndef ZD_BLOCK_GAPS_H
#define ZD_BLOCK_GAPS_H

#include "block.h"

/* message <- sentence on the gaps of the joints: at p (nq,) if `is_smallest`, otherwise in positions near p in which their sum of squares is
 * smallest. In the plane the sentence then names the loop with the largest gap of those that cannot close alone. If each can, and in space,
 * it names the three joints with the largest gaps. Returns ZD_DONE, a status of the core, or ZD_BAD_ARGUMENT for a block without names. */
int zd_block_explain_gaps(const zd_block *block, const double *p, int is_smallest, char *message, int message_size);
/* The same near the start of a block in any coordinates; `message` is unchanged if all joints can close. */
void zd_block_explain_start(const zd_block *block, char *message, int message_size);

#endif
