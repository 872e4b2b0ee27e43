/* The core in WebAssembly: plain functions over a block and its open run, see core.js. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "block/open_run/opened.h"

/* Parts of the C library that need a system: a clock that stands still, which gives steps all their time; no locales. */
#define SYSTEM __attribute__((weak))
SYSTEM _Thread_local int errno;
SYSTEM int timespec_get(struct timespec *t, int base) { return *t = (struct timespec){0}, base; }
SYSTEM char *strerror(int code) { (void)code; return ""; }
SYSTEM int wctomb(char *text, wchar_t code) { (void)text; (void)code; return -1; }

#define PAGE(type, name) __attribute__((export_name(#name))) type name
enum { MESSAGE = 2000 };

static char message[MESSAGE];       /* of page_open(), and names of constraints */

static const zd_system *system_of(const zd_opened *self) { return zd_block_system(zd_opened_block(self)); }
static const zd_measure *measure_of(const zd_opened *self, int i) { return system_of(self)->measures->measure + i; }

PAGE(void *, page_take)(size_t size) { return malloc(size); }
PAGE(void, page_give)(void *memory) { free(memory); }

PAGE(zd_opened *, page_open)(const void *data, size_t size, double t) { return zd_opened_create(data, size, t, message, MESSAGE); }
PAGE(zd_opened *, page_open_assembled)(const void *data, size_t size, double t)
{
    return zd_opened_create_assembled(data, size, t, message, MESSAGE);
}

PAGE(void, page_close)(zd_opened *self) { zd_opened_free(self); }
PAGE(const char *, page_error)(void) { return message; }
PAGE(const char *, page_message)(const zd_opened *self) { return zd_opened_message(self); }

PAGE(int, page_step)(zd_opened *self, double steps) { return zd_opened_step(self, steps); }
PAGE(int, page_advance)(zd_opened *self, double t) { return zd_opened_advance(self, t); }
PAGE(int, page_restart)(zd_opened *self, double t, const double *p, const double *v) { return zd_opened_restart(self, t, p, v); }
PAGE(int, page_assemble)(zd_opened *self, double t, const double *p, const double *v) { return zd_opened_assemble(self, t, p, v); }

PAGE(double, page_time)(const zd_opened *self) { return zd_run_time(zd_opened_run(self)); }
PAGE(const double *, page_p)(const zd_opened *self) { return zd_run_p(zd_opened_run(self)); }
PAGE(const double *, page_v)(const zd_opened *self) { return zd_run_v(zd_opened_run(self)); }
PAGE(int, page_nq)(const zd_opened *self) { return system_of(self)->nq; }
PAGE(int, page_nv)(const zd_opened *self) { return system_of(self)->nv; }
PAGE(int, page_m)(const zd_opened *self) { return system_of(self)->mh + system_of(self)->mn; }
PAGE(int, page_rank)(const zd_opened *self) { return (int)zd_run_statistics(zd_opened_run(self))->rank; }

PAGE(double, page_violation)(zd_opened *self) { return zd_opened_violation(self); }
PAGE(double, page_energy_violation)(zd_opened *self) { return zd_opened_energy_violation(self); }

/* Redundant constraints: rows (m,), increasing; returns their number. */
PAGE(int, page_redundant)(const zd_opened *self, int *rows) { return zd_run_redundant(zd_opened_run(self), rows); }

PAGE(const char *, page_constraint)(const zd_opened *self, int row)
{
    system_of(self)->name_constraint(system_of(self)->names, row, message, MESSAGE);
    return message;
}

PAGE(int, page_bodies)(const zd_opened *self) { return zd_block_bodies(zd_opened_block(self)); }
PAGE(int, page_pose)(const zd_opened *self) { return zd_block_poses(zd_opened_block(self), NULL, NULL, NULL); }
PAGE(void, page_poses)(zd_opened *self, double *poses) { zd_opened_poses(self, poses); }

PAGE(int, page_measures)(const zd_opened *self) { return system_of(self)->measures->count; }
PAGE(const char *, page_measure_name)(const zd_opened *self, int i) { return measure_of(self, i)->name; }
PAGE(const char *, page_measure_unit)(const zd_opened *self, int i) { return measure_of(self, i)->unit; }
PAGE(int, page_measure_size)(const zd_opened *self, int i) { return measure_of(self, i)->size; }
PAGE(int, page_measure)(zd_opened *self, int i, double *value) { return zd_opened_measure(self, i, value); }

PAGE(int, page_inputs)(const zd_opened *self) { return zd_block_inputs(zd_opened_block(self)); }
PAGE(const char *, page_input_name)(const zd_opened *self, int i) { return zd_block_input_name(zd_opened_block(self), i); }
PAGE(double, page_input)(const zd_opened *self, int i) { return zd_block_input(zd_opened_block(self), i); }
PAGE(int, page_set_input)(const zd_opened *self, int i, double value) { return zd_block_set_input(zd_opened_block(self), i, value); }

PAGE(int, page_parameters)(const zd_opened *self) { return zd_block_parameters(zd_opened_block(self)); }
PAGE(const char *, page_parameter_name)(const zd_opened *self, int i) { return zd_block_parameter_name(zd_opened_block(self), i); }
PAGE(double, page_parameter)(const zd_opened *self, int i) { return zd_block_parameter(zd_opened_block(self), i); }
PAGE(int, page_set_parameter)(zd_opened *self, int i, double value) { return zd_opened_set_parameter(self, i, value); }
