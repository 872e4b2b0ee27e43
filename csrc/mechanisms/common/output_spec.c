/* With the sign of (2), M vdot + d = f - C^T lambda, a row acts along its marker quantities with -lambda times its factors. */
#include "output_spec.h"

int zd_output_size(const zd_output_spec *measure, int of_forces, int of_torques)
{
    switch (measure->kind) {
    case ZD_VALUES:
    case ZD_RATES:
    case ZD_ACCELERATIONS: return measure->size;
    case ZD_JOINT_FORCE:
    case ZD_SUM:
    case ZD_SUM_OF_RATES:
    case ZD_SUM_OF_ACCELERATIONS:
    case ZD_FORCE_SUM: return of_forces;
    case ZD_JOINT_TORQUE:
    case ZD_ANGULAR_MOMENTUM:
    case ZD_INERTIA_TORQUE:
    case ZD_TORQUE_SUM: return of_torques;
    default: return 1;
    }
}

static enum zd_depends depends_on(const zd_output_spec *measure)
{
    switch (measure->kind) {
    case ZD_VALUES:
    case ZD_SUM: return ZD_OF_POSITIONS;
    case ZD_RATES:
    case ZD_SUM_OF_RATES:
    case ZD_ANGULAR_MOMENTUM: return ZD_OF_VELOCITIES;
    default: return ZD_OF_ACCELERATIONS;
    }
}

void zd_output_list(const zd_planned_elements *elements, int count, int of_forces, int of_torques, zd_measure *measure)
{
    for (int i = 0; i < count; i++) {
        const zd_output_spec *one = elements->output + i;
        measure[i] = (zd_measure){one->name, one->unit, zd_output_size(one, of_forces, of_torques), depends_on(one)};
    }
}

int zd_output_is_available(const zd_planned_elements *elements, const zd_output_spec *measure, const double *vdot, const double *lambda)
{
    switch (measure->kind) {
    case ZD_VALUES:
    case ZD_RATES:
    case ZD_SUM:
    case ZD_SUM_OF_RATES:
    case ZD_ANGULAR_MOMENTUM:
    case ZD_FORCE_VALUE:
    case ZD_FORCE_POWER:
    case ZD_FORCE_SUM:
    case ZD_TORQUE_SUM: return 1;
    case ZD_SUM_OF_ACCELERATIONS:
    case ZD_INERTIA_TORQUE:
    case ZD_ACCELERATIONS: return vdot != NULL;
    default: return vdot && (lambda || elements->m == 0);
    }
}

int zd_output_force(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, double *value)
{
    double rate;
    const int status = zd_force_evaluate(elements, at, elements->force + measure->index, t, value, &rate);
    if (measure->kind == ZD_FORCE_POWER) *value *= rate;
    return status;
}

int zd_drive_force(const zd_planned_elements *elements, const zd_readings *at, int relation, int term, double t, const double *lambda,
                    double *force)
{
    zd_combined all;
    const int row = elements->constraint_of_relation[relation], status = zd_combine(elements, at, elements->row + row, t, &all);
    *force = status ? 0 : -lambda[row] * (term < elements->row[row].terms ? all.factors[term] : 1);
    return status;
}

int zd_output_drive(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, const double *lambda,
                      double *value)
{
    const int status = zd_drive_force(elements, at, measure->index, measure->term, t, lambda, value);
    const zd_relation *row = elements->row + elements->constraint_of_relation[measure->index];
    if (measure->kind == ZD_DRIVE_POWER) *value *= zd_rate_of(at, elements->term[row->first].quantity);
    return status;
}
