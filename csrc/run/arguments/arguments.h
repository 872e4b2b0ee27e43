/* Checks of arguments; a failed check writes one sentence. */
#ifndef ZD_ARGUMENTS_H
#define ZD_ARGUMENTS_H

#include "../../zerodrift.h"

int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size);
/* Checks that quaternions in p have length 1, or with `any_length` that they are not zero; else ZD_BAD_START. */
int zd_check_quaternions(const zd_system *system, const double *p, int any_length, char *message, int size);
/* For a run: zd_check_method(), and the settings of times, steps, samples and outputs. */
int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size);

#endif
