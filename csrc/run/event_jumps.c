/* Events whose functions jump past zero where the phase changes, as those of forces do: the next step begins with their values before the
 * change, so that they are located, reported and acted at as any other.
 */
#include <math.h>

#include "phases.h"

static const double JUMP_ROUNDING = 1e-9;   /* value on one side of a jump, relative to that on the other, that is zero to rounding */

static int own_events(const zd_phases *phases) { return phases->own ? phases->own->count : 0; }

int zd_event_jumps_begin(zd_run *run)
{
    zd_phases *phases = run->phases;
    int status = ZD_DONE;
    if (phases->changes > 1) return status;     /* values before the first change of this instant */
    for (int i = 0; i < own_events(phases) && !status; i++) status = zd_watch_evaluate(&run->watch, i, &phases->passed[i]);
    return status;
}

void zd_event_jumps_finish(zd_run *run)
{
    zd_phases *phases = run->phases;
    for (int i = 0; i < own_events(phases); i++) {
        double *now = &run->watch.before[i];
        const double before = phases->passed[i], least = fmin(fabs(before), fabs(*now));
        if (phases->occurs[i] || !(least > JUMP_ROUNDING * fmax(fabs(before), fabs(*now)))) continue;
        if (zd_passes_zero(before, *now, phases->own->direction[i])) *now = before;
    }
}
