/* Meaning of a status, as a sentence. */
#ifndef ZD_STATUS_H
#define ZD_STATUS_H

#include "../zerodrift.h"

const char *zd_sentence(int status);

#endif
