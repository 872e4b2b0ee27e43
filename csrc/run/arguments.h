/* Refuses what no caller should hand in, with a sentence. */
#ifndef ZD_ARGUMENTS_H
#define ZD_ARGUMENTS_H

#include "../zerodrift.h"

int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size);
/* For a run also when it begins, ends and saves. */
int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size);

#endif
