/* Terms, parameters and start of the four-bar mechanisms, free and driven. */
#ifndef ZD_FOUR_BAR_H
#define ZD_FOUR_BAR_H

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "../include/zerodrift/system.h"

enum { ZD_FOUR_BAR_N = 3, ZD_FOUR_BAR_SCRATCH = 2 * ZD_FOUR_BAR_N };

/* parameters, in the order of the tables; the first ZD_FOUR_BAR_CLOSED_FORM are those of the closed-form functions */
enum { ZD_FOUR_BAR_CLOSED_FORM = 11 };

typedef struct zd_four_bar_given {
    double l[4];        /* m: l0 ... l3 */
    double m[3];        /* kg */
    double J[3];        /* kg m^2 */
    double g;           /* m/s^2 */
    double crossed;
    double angle, rate; /* alpha_1(0), rad; its rate, rad/s */
} zd_four_bar_given;

/* constants of evaluate(), from the parameters */
typedef struct zd_four_bar_constants {
    double l0, l[ZD_FOUR_BAR_N];
    double side;                        /* side of the diagonal with joint 3: 1 open, -1 crossed; 0: changes where both assemblies meet */
    double diagonal[ZD_FOUR_BAR_N];     /* M_ii, kg m^2 */
    double k12, k13, k23;               /* M_ij / cos(alpha_j - alpha_i), kg m^2 */
    double weight[ZD_FOUR_BAR_N];       /* -f_i / cos(alpha_i), N m */
} zd_four_bar_constants;

/* The terms of the paper's section 4.1; the closure is the first two rows. Takes the constants as `data`. */
zd_evaluate zd_four_bar_evaluate;
const char *zd_four_bar_prepare(const zd_four_bar_given *given, zd_four_bar_constants *to);
void zd_four_bar_fill(const zd_four_bar_given *given, double *to);      /* parameters of the closed-form functions */
void zd_four_bar_start(const zd_four_bar_given *given, double *p, double *v);
void zd_four_bar_draw(const double *constants, const double *p, double *points);

extern const zd_variable zd_four_bar_coordinate[], zd_four_bar_velocity[];

/* the first rows of the table of parameters */
#define ZD_FOUR_BAR_PARAMETERS                                                                                           \
    {"lengths", "m", "ground l0 and links l1, l2, l3", 4, ZD_POSITIVE, (const double[]){1, 0.3, 1, 0.6}},                \
    {"masses", "kg", "of links 1, 2, 3", 3, ZD_POSITIVE, (const double[]){1.5, 5, 3}},                                   \
    {"inertias", "kg m^2", "about the link midpoints; left out: slender rods, m l^2 / 12", 3, ZD_NOT_NEGATIVE, NULL},    \
    {"gravity", "m/s^2", "downwards, along -y", 1, ZD_ANY, (const double[]){9.81}},                                      \
    {"assembly", "", "open crossed", 1, ZD_CHOICE, (const double[]){0}},                                                 \
    {"crank_angle", "rad", "alpha1 at the start", 1, ZD_ANY, (const double[]){0x1.921fb54442d18p+0}}

#endif
