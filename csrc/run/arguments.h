/* Refuses what no caller should hand in, with a sentence. */
#ifndef ZD_ARGUMENTS_H
#define ZD_ARGUMENTS_H

#include "../zerodrift.h"

int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size);
/* A quaternion in p that is far from length 1, or with `any_length` zero: ZD_BAD_START. */
int zd_check_quaternions(const zd_system *system, const double *p, int any_length, char *message, int size);
/* For a run also when it begins, ends and saves. */
int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size);

#endif
