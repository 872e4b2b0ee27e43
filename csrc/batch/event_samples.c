#include "batch.h"

#include "../linalg/small.h"

static int count_events(const zd_batch *batch)
{
    return batch->settings->events ? batch->settings->events->count : 0;
}

int64_t *zd_event_samples_count(const zd_batch *batch, int64_t run, int event)
{
    return batch->found + run * count_events(batch) + event;
}

void zd_event_samples_clear(const zd_batch *batch, int64_t run)
{
    for (int event = 0; event < count_events(batch); event++) *zd_event_samples_count(batch, run, event) = 0;
}

static void write(double *to, int64_t place, int count, const double *from)
{
    if (to) zd_copy_all(count, from, to + place * count);
}

int zd_event_samples_add(void *found, int event, double t, const double *p, const double *v)
{
    const zd_event_samples *self = found;
    const zd_batch *batch = self->batch;
    const int64_t number = (*zd_event_samples_count(batch, self->run, event))++;
    if (number >= batch->events_capacity) return ZD_DONE;
    const int64_t place = (self->run * count_events(batch) + event) * batch->events_capacity + number;
    write(batch->t_events, place, 1, &t);
    write(batch->p_events, place, batch->system->nq, p);
    write(batch->v_events, place, batch->system->nv, v);
    return ZD_DONE;
}
