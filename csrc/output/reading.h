/* Numbers of the motion that events are made of, where the core knows how: without asking anybody. */
#ifndef ZD_READING_H
#define ZD_READING_H

#include "../workspace.h"
#include "../zerodrift.h"

typedef struct zd_reader {
    const zd_events *events;    /* NULL: there are none */
    const zd_system *of;    /* whose measures are read */
    double *x;              /* what an event is a function of: as much as any of them takes */
    double *measured;       /* a measure, of the largest size */
    double *scratch;        /* of the measures */
} zd_reader;

zd_reader zd_reader_take(zd_arena *arena, const zd_events *events, const zd_system *run);
/* Why they cannot be read, in a sentence; NULL: they can be. */
const char *zd_wrong_readings(const zd_events *events, const zd_system *run);
/* Whether the core knows the event, or has to ask. */
static inline int zd_is_known(const zd_events *events, int event) { return events->known && events->known[event].readings > 0; }
/* The value of an event that the core knows, of a system with this data; ZD_CALLBACK where that is not finite or a measure fails. */
int zd_read_event(const zd_reader *self, const void *data, int event, double t, const double *p, const double *v, double *value);

#endif
