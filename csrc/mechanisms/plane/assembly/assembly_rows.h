/* The rows that an assembly meets: joints, couplings, drives and targets, and their Jacobian in scaled coordinates. */
#ifndef ZD_PLANE_ASSEMBLY_ROWS_H
#define ZD_PLANE_ASSEMBLY_ROWS_H

#include "../../../workspace.h"
#include "../tables.h"

/* Conditions of a start in addition to closed joints */
typedef struct zd_wanted {
    double length;              /* m: how large the mechanism is */
    int targets;
    const zd_target *target;
    int drives;                 /* relations that prescribe constant speeds, from wherever the start has their coordinates */
    const int *drive;
} zd_wanted;

typedef struct zd_assembly {
    const zd_plane *mechanism;
    const zd_system *system;
    double length;
    int n, mh, m, most;     /* most: rows of m and of all targets */
    int targets;
    const zd_target *target;
    const zd_wanted *wanted;
    zd_terms terms;
    double *scratch, *at_rest;          /* (measures' scratch,), (n,) zeros */
    double *staying;                    /* (targets,) values of targets that stay, once they are known */
    int knows_staying;
    double *scale, *weight;             /* (n,) */
    double *size[2];                    /* (most,): of the rows without targets and with them, where they were first met */
    int is_known[2];
    double *dense, *r, *J, *Q, *L;      /* (m, n), (most,), (most, n), (most, n), (most, most) */
    double *y, *step, *tried, *start;   /* (most,), (n,), (n,), (most,) */
    int rows, firm;                     /* number of rows of r and J; the first `firm` of them exclude the targets that stay */
} zd_assembly;

enum zd_assembly_choice {
    ZD_OF_ALL,
    ZD_OF_DRAWING,      /* joints, and couplings without a law, as gears are */
    ZD_OF_JOINTS
};

/* Which rows are meant, and how much of what they were at the start is left to them */
typedef struct zd_assembly_problem {
    enum zd_assembly_choice choice;
    int held;
    double left;
} zd_assembly_problem;

zd_assembly zd_assembly_take(zd_arena *arena, const zd_plane *mechanism, const zd_wanted *wanted);
/* The square root of the mass metric, in scaled coordinates */
void zd_assembly_weigh(zd_assembly *self, const double *p);
/* The component of a measure that a target means; row (3, n), or NULL, <- the derivatives of the measure by velocities */
double zd_assembly_measure(zd_assembly *self, const zd_target *target, const double *p, double *row);
/* r and J of rows 0 ... count - 1 of C, and of the targets that are rates or not; in scaled coordinates */
void zd_assembly_write_rows(zd_assembly *self, const double *p, int count, int targets, int rates);
double zd_assembly_length_of(const zd_assembly *self, int row);
void zd_assembly_divide_row(zd_assembly *self, int row, double by);
/* In units of their sizes where they were first met: these must not change while squares are made least. */
void zd_assembly_divide_by_sizes(zd_assembly *self, int which);
int zd_assembly_is_of_joint(const zd_assembly *self, int row);
/* The drive of constant speed that a row of C is, of those wanted; -1: it is none. */
int zd_assembly_drive_of(const zd_assembly *self, int row);
/* r and J of the problem at p, without such drives; returns the largest |r| */
double zd_assembly_find(zd_assembly *self, const zd_assembly_problem *of, const double *p);

#endif
