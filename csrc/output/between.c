/* Values between steps: from where the step began, a shorter one of the same method is made to each time that is wanted, and
 * corrected like any other. So the values satisfy the constraints and have the error of the method, whichever it is.
 */
#include "../core.h"
#include "../linalg/small.h"

static size_t extra_bytes(const zd_run *run)
{
    return (size_t)(run->rate.size - run->own_size) * sizeof(double);
}

void zd_place_keep(const zd_run *run, zd_place *place)
{
    place->t = run->t;
    ZD_SIZED(zd_copy, run->system.nq, run->point->p, place->p);
    ZD_SIZED(zd_copy, run->system.nv, run->point->v, place->v);
    if (extra_bytes(run)) memcpy(place->extra, run->y + run->own_size, extra_bytes(run));
}

int zd_place_return(zd_run *run, const zd_place *place)
{
    run->state = run->y;
    memcpy(run->y + run->own_size, place->extra, extra_bytes(run));
    return zd_run_place(run, place->t, place->p, place->v);
}

void zd_output_before(zd_run *run)
{
    zd_place_keep(run, &run->output.before);
}

void zd_output_keep_end(zd_run *run)
{
    zd_place_keep(run, &run->output.after);
}

int zd_output_move(zd_run *run, double t)
{
    const zd_place *before = &run->output.before;
    if (t == run->output.after.t) return zd_place_return(run, &run->output.after);
    int status = zd_place_return(run, before);
    run->output.between = 1;
    if (!status) status = zd_run_integrate(run, t - before->t);
    if (!status) status = zd_run_land(run, t);
    run->output.between = 0;
    run->statistics.output_steps++;
    return status;
}

static int is_wanted(const zd_run *run, double until)
{
    return !zd_output_is_complete(run) && run->settings.t_eval[run->output.next] <= until;
}

int zd_output_after(zd_run *run, zd_record *record)
{
    double t1 = run->t;
    int status = ZD_DONE, away = 0;
    if (is_wanted(run, t1)) zd_output_keep_end(run);
    while (!status && is_wanted(run, nextafter(t1, -INFINITY))) {
        away = 1;
        status = zd_output_move(run, run->settings.t_eval[run->output.next++]);
        if (!status) status = zd_record_row(run, record);
    }
    if (!status && away) status = zd_output_move(run, t1);
    int here = is_wanted(run, t1);
    if (status || !(here || run->watch.ended)) return status;
    run->output.next += here;
    return zd_record_row(run, record);
}

int zd_output_is_complete(const zd_run *run)
{
    return run->output.next == run->settings.t_evals;
}
