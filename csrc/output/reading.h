/* Quantities that event functions read: time, coordinates, velocities and measures; and the functions that need no callback. */
#pragma once

#include "../contact/phase_system.h"
#include "../motion/motion.h"
#include "../point/point.h"
#include "../workspace.h"
#include "../zerodrift.h"

typedef struct zd_reader {
    const zd_events *events;    /* NULL: none */
    const zd_system *of;    /* system whose measures are read */
    const double *inputs;   /* (2 inputs + 1,): of the simulated system */
    const zd_point *point;  /* whose accelerations and multipliers are read; NULL: none are */
    double *x;              /* arguments of an event function; size: the largest number of arguments */
    double *measured;       /* values of a measure; size: the largest one */
    double *scratch;        /* scratch memory of the measures */
} zd_reader;

zd_reader zd_reader_create(zd_arena *arena, const zd_events *events, const zd_system *run, const double *inputs, const zd_point *point);
/* The reason, in one sentence, for which the events cannot be evaluated; NULL: they can. */
const char *zd_wrong_readings(const zd_events *events, const zd_system *run);
/* True if the core evaluates the event itself, false if it calls the callback. */
static inline int zd_is_known(const zd_events *events, int event)
{
    return events->known && events->known[event].readings > 0 && !events->known[event].is_called;
}
/* True if the event has an action. */
int zd_acts(const zd_events *events, int event);
/* True if the event reads reactions or accelerations, in this phase. */
int zd_reads_accelerations(const zd_events *events, const zd_system *run, const zd_phase_system *phase, int event);
/* *value <- that of an event, for a system with this data; ZD_CALLBACK if it is not finite, or a measure or the callback fails. Requires the
 * accelerations and multipliers at this state if it reads them. */
int zd_read_event(const zd_reader *self, const void *data, int event, double t, const double *p, const double *v, double *value);

/* Recorder: writes one sample into the caller's arrays for each saved instant. */

typedef struct zd_recorder {
    zd_motion *motion;
    const zd_outputs *outputs;      /* measures recorded in every sample; NULL: none */
    const zd_system *measured;      /* system of these measures */
    int width;                      /* number of components of all of them */
    double *scratch;                /* scratch memory of the measures */
    int needs;                      /* bits of the terms needed for a sample, evaluated in one call */
} zd_recorder;

zd_recorder zd_recorder_create(zd_arena *arena, const zd_settings *settings, zd_motion *motion);
static inline int zd_record_has_room(const zd_record *record) { return record->samples < record->capacity; }
/* Adds a sample of the present point; ZD_FULL if there is no space, and nothing is changed. */
int zd_recorder_add(zd_recorder *self, zd_record *record);
