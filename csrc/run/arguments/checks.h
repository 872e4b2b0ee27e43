/* Checks of what callers give; a failed check writes one sentence. */
#pragma once

#include "../../zerodrift.h"

/* Checks of arguments; a failed check writes one sentence. */

int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size);
/* Checks that quaternions in p have length 1, or with `any_length` that they are not zero; else ZD_BAD_START. */
int zd_check_quaternions(const zd_system *system, const double *p, int any_length, char *message, int size);
/* For a run: zd_check_method(), and the settings of times, steps, samples and outputs. */
int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size);

/* Checks of the optional members of zd_system; a failed check writes one sentence. */

enum { ZD_LARGEST_PACKED = 0x100000 };  /* the same for systems that declare their structure */
enum { ZD_LARGEST = 8192 };     /* maximum number of coordinates, and of velocities: sizes of dense matrices must fit an int */

/* Sizes and terms of the system must be checked before. */
int zd_check_interface(const zd_system *system, char *message, int size);
