/* What a corrected step of the paper's four-bar costs in code that can do nothing else: n = 3 and m = 2 written out, no tables,
 * no memory. RK4 on (13), then (27a) to the tolerance, (27b), (29a). All follows from three solves with M = L L^T:
 *
 *     W = M^-1 C^T  (3 x 2),    S = C W  (2 x 2),    x = M^-1 g - W S^-1 (C M^-1 g - r)    solves    M x + C^T lambda = g,  C x = r
 */
#include "four_bar_floor.h"

#include <math.h>

#define EACH(i) for (int i = 0; i < 3; i++)

typedef struct bar {    /* constants of the mechanism */
    double length[3], ground;
    double inertia[3], product[3];      /* M_ii; M_12, M_13, M_23 before their cosines */
    double moment[3];                   /* gravity times arm */
} bar;

typedef struct pose {   /* what depends on the angles */
    double s[3], c[3];
    double M12, M13, M23;
    double l21, l31, l32, e1, e2, e3;   /* L, and one over its diagonal */
    double W[2][3];
    double g21, i1, i2;                 /* Cholesky factor of S in the same form */
} pose;

static bar paper(void)
{
    const double m1 = 1.5, m2 = 5, m3 = 3, l1 = 0.3, l2 = 1, l3 = 0.6, g = 9.81;
    return (bar){
        .length = {l1, l2, l3},
        .ground = 1,
        .inertia = {(m1 / 3 + m2 + m3) * l1 * l1, (m2 / 3 + m3) * l2 * l2, m3 / 3 * l3 * l3},
        .product = {(m2 / 2 + m3) * l1 * l2, m3 / 2 * l1 * l3, m3 / 2 * l2 * l3},
        .moment = {g * l1 * (m1 / 2 + m2 + m3), g * l2 * (m2 / 2 + m3), g * l3 * m3 / 2},
    };
}

static inline void turn(pose *at, const double *angle)
{
    EACH(i) {
        at->s[i] = sin(angle[i]);
        at->c[i] = cos(angle[i]);
    }
}

static inline void solve_mass(const pose *at, double g1, double g2, double g3, double *x)
{
    double z1 = g1 * at->e1, z2 = (g2 - at->l21 * z1) * at->e2, z3 = (g3 - at->l31 * z1 - at->l32 * z2) * at->e3;
    x[2] = z3 * at->e3;
    x[1] = (z2 - at->l32 * x[2]) * at->e2;
    x[0] = (z1 - at->l21 * x[1] - at->l31 * x[2]) * at->e1;
}

/* C times x: rows -length sin, length cos */
static inline double row_x(const bar *b, const pose *at, const double *x)
{
    return -(b->length[0] * at->s[0] * x[0] + b->length[1] * at->s[1] * x[1] + b->length[2] * at->s[2] * x[2]);
}

static inline double row_y(const bar *b, const pose *at, const double *x)
{
    return b->length[0] * at->c[0] * x[0] + b->length[1] * at->c[1] * x[1] + b->length[2] * at->c[2] * x[2];
}

static inline void decompose(const bar *b, pose *at)
{
    const double *s = at->s, *c = at->c, *l = b->length;
    at->M12 = b->product[0] * (c[0] * c[1] + s[0] * s[1]);
    at->M13 = b->product[1] * (c[0] * c[2] + s[0] * s[2]);
    at->M23 = b->product[2] * (c[1] * c[2] + s[1] * s[2]);
    at->e1 = 1 / sqrt(b->inertia[0]);
    at->l21 = at->M12 * at->e1;
    at->l31 = at->M13 * at->e1;
    at->e2 = 1 / sqrt(b->inertia[1] - at->l21 * at->l21);
    at->l32 = (at->M23 - at->l31 * at->l21) * at->e2;
    at->e3 = 1 / sqrt(b->inertia[2] - at->l31 * at->l31 - at->l32 * at->l32);
    solve_mass(at, -l[0] * s[0], -l[1] * s[1], -l[2] * s[2], at->W[0]);
    solve_mass(at, l[0] * c[0], l[1] * c[1], l[2] * c[2], at->W[1]);
    double xx = row_x(b, at, at->W[0]), xy = row_x(b, at, at->W[1]), yy = row_y(b, at, at->W[1]);
    at->i1 = 1 / sqrt(xx);
    at->g21 = xy * at->i1;
    at->i2 = 1 / sqrt(yy - at->g21 * at->g21);
}

/* x -= W S^-1 r */
static inline void remove_along(const pose *at, double r1, double r2, double *x)
{
    double z1 = r1 * at->i1, b = (r2 - at->g21 * z1) * at->i2 * at->i2, a = (z1 - at->g21 * b) * at->i1;
    EACH(i) x[i] -= at->W[0][i] * a + at->W[1][i] * b;
}

static void accelerate(const bar *b, const double *angle, const double *rate, double *to)
{
    pose at;
    turn(&at, angle);
    decompose(b, &at);
    const double *s = at.s, *c = at.c, *l = b->length;
    double w1 = rate[0] * rate[0], w2 = rate[1] * rate[1], w3 = rate[2] * rate[2];
    double q12 = b->product[0] * (s[0] * c[1] - c[0] * s[1]), q13 = b->product[1] * (s[0] * c[2] - c[0] * s[2]);
    double q23 = b->product[2] * (s[1] * c[2] - c[1] * s[2]);
    solve_mass(&at, -b->moment[0] * c[0] - q12 * w2 - q13 * w3, -b->moment[1] * c[1] + q12 * w1 - q23 * w3,
               -b->moment[2] * c[2] + q13 * w1 + q23 * w2, to);
    remove_along(&at, row_x(b, &at, to) - (l[0] * c[0] * w1 + l[1] * c[1] * w2 + l[2] * c[2] * w3),
                 row_y(b, &at, to) - (l[0] * s[0] * w1 + l[1] * s[1] * w2 + l[2] * s[2] * w3), to);     /* (13) */
}

static void step(const bar *b, double h, double *angle, double *rate)
{
    static const double ahead[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    double slope[3] = {0}, bend[3] = {0}, turned[3] = {0}, changed[3] = {0};
    for (int stage = 0; stage < 4; stage++) {
        double a[3], w[3];
        EACH(i) {
            a[i] = angle[i] + h * ahead[stage] * slope[i];
            w[i] = rate[i] + h * ahead[stage] * bend[i];
            slope[i] = w[i];
        }
        accelerate(b, a, w, bend);
        EACH(i) {
            turned[i] += weight[stage] * slope[i];
            changed[i] += weight[stage] * bend[i];
        }
    }
    EACH(i) {
        angle[i] += h * turned[i];
        rate[i] += h * changed[i];
    }
}

static inline double energy(const bar *b, const pose *at, const double *w, double *kinetic)
{
    *kinetic = w[0] * (at->M12 * w[1] + at->M13 * w[2]) + w[1] * at->M23 * w[2];
    double potential = 0;
    EACH(i) {
        *kinetic += 0.5 * b->inertia[i] * w[i] * w[i];
        potential += b->moment[i] * at->s[i];
    }
    return *kinetic + potential;
}

static void correct(const bar *b, double tolerance, double energy0, double *angle, double *rate)
{
    pose at;
    const double *l = b->length;
    for (int iteration = 0;; iteration++) {
        turn(&at, angle);
        double x = l[0] * at.c[0] + l[1] * at.c[1] + l[2] * at.c[2] - b->ground;
        double y = l[0] * at.s[0] + l[1] * at.s[1] + l[2] * at.s[2];
        decompose(b, &at);
        if ((fabs(x) <= tolerance && fabs(y) <= tolerance) || iteration == 10) break;
        remove_along(&at, x, y, angle);                                             /* (27a) */
    }
    remove_along(&at, row_x(b, &at, rate), row_y(b, &at, rate), rate);              /* (27b) */
    double kinetic, excess = energy(b, &at, rate, &kinetic) - energy0, factor = sqrt(1 - excess / kinetic);
    EACH(i) rate[i] *= factor;                                                      /* (29a) */
}

double four_bar_floor(const double *start, const double *rates, double h, int steps, double tolerance)
{
    const bar b = paper();
    double angle[3], rate[3], kinetic;
    pose at;
    EACH(i) {
        angle[i] = start[i];
        rate[i] = rates[i];
    }
    turn(&at, angle);
    decompose(&b, &at);
    double energy0 = energy(&b, &at, rate, &kinetic);
    for (int k = 0; k < steps; k++) {
        step(&b, h, angle, rate);
        correct(&b, tolerance, energy0, angle, rate);
    }
    return angle[0];
}
