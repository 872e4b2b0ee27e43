/* What a corrected step of a row of N parallelograms costs by hand: RK4 on (13), one position iteration (27a) and one velocity correction
 * (27b), in absolute coordinates. Factors of the velocity correction serve the first stage of the next step. Rods have 1 m and 1 kg.
 *
 *     planar_floor N ...      prints "bodies N microseconds" and "blocks N microseconds" of a step, and what Phi is in the end
 *
 * For "bodies" C is never stored; for "blocks" each pin fills blocks of 2 x 3 that are multiplied as they are, and W = M^-1 is a full block
 * of each body. S = C W C^T has 2 x 2 blocks. Pins on the ground are eliminated first, which adds no fill; the others are a chain then, and
 * are taken from its ends in turn, so that two chains of operations need not wait for one another. The ground is body 0, without inverse
 * mass.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <zerodrift/sines.h>

static const double GRAVITY = 9.81, STEP = 0.01, ANGLE = -0.7;

typedef struct pin {
    int body[2];
    double point[2][2];         /* on each of them, from its centre */
    int below, row[2], at;      /* pins that are coupled with it and come later, and where their blocks begin in S */
    int target;                 /* the block of these two, where there are two */
} pin;

typedef struct meeting {        /* of two pins on a body */
    int earlier, later, side[2], body, at;
} meeting;

typedef struct bars {
    int bodies, pins, meetings, blocks, is_stored, has_factors;
    pin *pin;
    meeting *meeting;
    double (*per)[3];           /* (bodies,): 1/m, 1/m, 1/J */
    double (*W)[6];             /* the same as full blocks, of which the upper triangle is stored */
    double *angle, *sine, *cosine;
    double (*arm)[2][2];        /* (pins,): from each body's centre */
    double (*C)[2][6], (*CW)[2][6];     /* (pins,): two rows for each body */
    double (*D)[3], (*S)[4], (*y)[2];   /* diagonal blocks, then their inverses; those below; right side, then multipliers */
    double *state[8];           /* (3 bodies,): of the stages */
} bars;

static void *take(int count, size_t size)
{
    void *memory = calloc((size_t)count + 1, size);
    if (!memory) exit(1);
    return memory;
}

/* ---- once ---- */

static int chain_place(int n, int j) { return n + 1 + (j < n ? 2 * j : 2 * (2 * n - 1 - j) + 1); }

static void put_below(bars *m, int k, int row)
{
    pin *of = m->pin + k;
    if (of->below++ == 0) of->at = m->blocks;
    of->row[of->below - 1] = row;
    m->blocks++;
}

static int block_of(const bars *m, int column, int row)
{
    const pin *of = m->pin + column;
    return of->at + (of->below == 2 && of->row[1] == row);
}

static void meet(bars *m, int a, int side_of_a, int b, int side_of_b)
{
    const int is_first = a < b, earlier = is_first ? a : b, later = is_first ? b : a;
    m->meeting[m->meetings++] = (meeting){earlier, later, {is_first ? side_of_a : side_of_b, is_first ? side_of_b : side_of_a},
                                          m->pin[a].body[side_of_a], block_of(m, earlier, later)};
}

/* Crank i is body 1 + 2 i, bar i is 2 + 2 i; of the chain, pin 2 i is where bar i begins, and 2 i + 1 where it ends. */
static void connect(bars *m, int n)
{
    for (int i = 0; i <= n; i++) {
        int below[2], count = 0;
        m->pin[i] = (pin){.body = {0, 1 + 2 * i}, .point = {{i, 0}, {-0.5, 0}}};
        if (i > 0) below[count++] = chain_place(n, 2 * i - 1);
        if (i < n) below[count++] = chain_place(n, 2 * i);
        const int turned = count == 2 && below[1] < below[0];
        for (int b = 0; b < count; b++) put_below(m, i, below[turned ? 1 - b : b]);
    }
    for (int place = 0; place < 2 * n; place++) {
        const int j = place % 2 ? 2 * n - 1 - place / 2 : place / 2, k = n + 1 + place;
        m->pin[k] = (pin){.body = {1 + j, 2 + j}, .point = {{0.5, 0}, {j % 2 ? 0.5 : -0.5, 0}}};
        if (j % 2) m->pin[k].point[1][0] = 0.5;
        if (place < 2 * n - 1) put_below(m, k, chain_place(n, j < n ? j + 1 : j - 1));
    }
    for (int i = 0; i <= n; i++) {
        if (m->pin[i].below == 2) m->pin[i].target = block_of(m, m->pin[i].row[0], m->pin[i].row[1]);
        if (i > 0) meet(m, i, 1, chain_place(n, 2 * i - 1), 1);
        if (i < n) meet(m, i, 1, chain_place(n, 2 * i), 0);
        if (i > 0 && i < n) meet(m, chain_place(n, 2 * i - 1), 1, chain_place(n, 2 * i), 0);
        if (i < n) meet(m, chain_place(n, 2 * i), 1, chain_place(n, 2 * i + 1), 0);
    }
}

static bars *create(int n, int is_stored)
{
    bars *m = take(1, sizeof *m);
    *m = (bars){.bodies = 2 * n + 2, .pins = 3 * n + 1, .is_stored = is_stored};
#define TAKE(member, count) m->member = take(count, sizeof *m->member)
    TAKE(pin, m->pins); TAKE(meeting, 4 * n + 4); TAKE(per, m->bodies); TAKE(W, m->bodies); TAKE(angle, m->bodies); TAKE(sine, m->bodies);
    TAKE(cosine, m->bodies); TAKE(arm, m->pins); TAKE(C, m->pins); TAKE(CW, m->pins); TAKE(D, m->pins); TAKE(S, 4 * n + 4); TAKE(y, m->pins);
#undef TAKE
    for (int i = 0; i < 8; i++) m->state[i] = take(3 * m->bodies, sizeof(double));
    for (int b = 1; b < m->bodies; b++) {
        memcpy(m->per[b], (double[]){1, 1, 12}, sizeof *m->per);
        m->W[b][0] = m->W[b][3] = 1, m->W[b][5] = 12;
    }
    connect(m, n);
    return m;
}

static void release(bars *m)
{
    void *all[] = {m->pin, m->meeting, m->per, m->W, m->angle, m->sine, m->cosine, m->arm, m->C, m->CW, m->D, m->S, m->y};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    for (int i = 0; i < 8; i++) free(m->state[i]);
    free(m);
}

/* ---- where the pins are, and what they ask for ---- */

static void turn(bars *m, const double *p)
{
    for (int b = 0; b < m->bodies; b++) m->angle[b] = p[3 * b + 2];
    zd_sines(m->bodies, m->angle, m->sine, m->cosine);
    for (int k = 0; k < m->pins; k++) {
        const pin *of = m->pin + k;
        const double sa = m->sine[of->body[0]], ca = m->cosine[of->body[0]], sb = m->sine[of->body[1]], cb = m->cosine[of->body[1]];
        double (*arm)[2] = m->arm[k];
        arm[0][0] = ca * of->point[0][0] - sa * of->point[0][1];
        arm[0][1] = sa * of->point[0][0] + ca * of->point[0][1];
        arm[1][0] = cb * of->point[1][0] - sb * of->point[1][1];
        arm[1][1] = sb * of->point[1][0] + cb * of->point[1][1];
    }
    for (int k = 0; m->is_stored && k < m->pins; k++) {
        double *A = m->C[k][0], *B = m->C[k][1];
        A[0] = A[4] = 1, A[1] = A[3] = 0, A[2] = -m->arm[k][0][1], A[5] = m->arm[k][0][0];
        B[0] = B[4] = -1, B[1] = B[3] = 0, B[2] = m->arm[k][1][1], B[5] = -m->arm[k][1][0];
    }
}

static double violation(bars *m, const double *p)
{
    double worst = 0;
    for (int k = 0; k < m->pins; k++) {
        const double *a = p + 3 * m->pin[k].body[0], *b = p + 3 * m->pin[k].body[1], *u = m->arm[k][0], *w = m->arm[k][1];
        const double x = a[0] + u[0] - b[0] - w[0], y = a[1] + u[1] - b[1] - w[1], larger = fabs(x) > fabs(y) ? fabs(x) : fabs(y);
        m->y[k][0] = x, m->y[k][1] = y;
        worst = larger > worst ? larger : worst;
    }
    return worst;
}

/* y <- C x - xi, xi being that of v; v NULL: zero */
static void right_side(bars *m, const double *x, const double *v)
{
    for (int k = 0; k < m->pins; k++) {
        const double *a = x + 3 * m->pin[k].body[0], *b = x + 3 * m->pin[k].body[1], *u = m->arm[k][0], *w = m->arm[k][1];
        const double *A = m->C[k][0], *B = m->C[k][1];
        if (m->is_stored) {
            m->y[k][0] = A[0] * a[0] + A[1] * a[1] + A[2] * a[2] + B[0] * b[0] + B[1] * b[1] + B[2] * b[2];
            m->y[k][1] = A[3] * a[0] + A[4] * a[1] + A[5] * a[2] + B[3] * b[0] + B[4] * b[1] + B[5] * b[2];
        } else {
            m->y[k][0] = a[0] - a[2] * u[1] - b[0] + b[2] * w[1];
            m->y[k][1] = a[1] + a[2] * u[0] - b[1] - b[2] * w[0];
        }
    }
    for (int k = 0; v && k < m->pins; k++) {
        const double wa = v[3 * m->pin[k].body[0] + 2], wb = v[3 * m->pin[k].body[1] + 2], *u = m->arm[k][0], *w = m->arm[k][1];
        m->y[k][0] -= wa * wa * u[0] - wb * wb * w[0];
        m->y[k][1] -= wa * wa * u[1] - wb * wb * w[1];
    }
}

/* ---- S ---- */

static void weigh(const double *C, const double *W, double *to)
{
    for (int r = 0; r < 6; r += 3) {
        const double x = C[r], y = C[r + 1], z = C[r + 2];
        to[r] = x * W[0] + y * W[1] + z * W[2];
        to[r + 1] = x * W[1] + y * W[3] + z * W[4];
        to[r + 2] = x * W[2] + y * W[4] + z * W[5];
    }
}

static double inner(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void assemble_stored(bars *m)
{
    for (int k = 0; k < m->pins; k++) {
        const double *A = m->C[k][0], *B = m->C[k][1];
        double *X = m->CW[k][0], *Y = m->CW[k][1], *D = m->D[k];
        weigh(A, m->W[m->pin[k].body[0]], X);
        weigh(B, m->W[m->pin[k].body[1]], Y);
        D[0] = inner(X, A) + inner(Y, B);
        D[1] = inner(X, A + 3) + inner(Y, B + 3);
        D[2] = inner(X + 3, A + 3) + inner(Y + 3, B + 3);
    }
    for (const meeting *it = m->meeting; it < m->meeting + m->meetings; it++) {
        const double *X = m->CW[it->earlier][it->side[0]], *C = m->C[it->later][it->side[1]];
        double *S = m->S[it->at];
        S[0] += inner(C, X);
        S[1] += inner(C, X + 3);
        S[2] += inner(C + 3, X);
        S[3] += inner(C + 3, X + 3);
    }
}

static void assemble(bars *m)
{
    memset(m->S, 0, (size_t)m->blocks * sizeof *m->S);
    if (m->is_stored) {
        assemble_stored(m);
        return;
    }
    for (int k = 0; k < m->pins; k++) {
        const double *a = m->per[m->pin[k].body[0]], *b = m->per[m->pin[k].body[1]], *u = m->arm[k][0], *w = m->arm[k][1];
        m->D[k][0] = a[0] + b[0] + a[2] * u[1] * u[1] + b[2] * w[1] * w[1];
        m->D[k][1] = -a[2] * u[0] * u[1] - b[2] * w[0] * w[1];
        m->D[k][2] = a[1] + b[1] + a[2] * u[0] * u[0] + b[2] * w[0] * w[0];
    }
    for (const meeting *it = m->meeting; it < m->meeting + m->meetings; it++) {
        const double *u = m->arm[it->earlier][it->side[0]], *w = m->arm[it->later][it->side[1]], *per = m->per[it->body];
        const double sign = it->side[0] == it->side[1] ? 1 : -1, x = sign * per[2] * u[0], y = sign * per[2] * u[1];
        double *S = m->S[it->at];
        S[0] += sign * per[0] + w[1] * y;
        S[1] -= w[1] * x;
        S[2] -= w[0] * y;
        S[3] += sign * per[1] + w[0] * x;
    }
}

/* y <- D^-1 L^-1 y as S is factored: with P the inverse pivot and B the blocks below it, which stay as they are */
static void factor(bars *m)
{
    for (int k = 0; k < m->pins; k++) {
        const pin *of = m->pin + k;
        double *D = m->D[k], *y = m->y[k], *B = m->S[of->at];
        const double scale = 1 / (D[0] * D[2] - D[1] * D[1]), p = D[2] * scale, q = -D[1] * scale, r = D[0] * scale;
        const double y0 = p * y[0] + q * y[1], y1 = q * y[0] + r * y[1];
        D[0] = p, D[1] = q, D[2] = r, y[0] = y0, y[1] = y1;
        double c0 = 0, c1 = 0, c2 = 0, c3 = 0;          /* of the block before */
        for (int e = 0; e < of->below; e++, B += 4) {
            const double b0 = B[0], b1 = B[1], b2 = B[2], b3 = B[3];
            const double l0 = b0 * p + b1 * q, l1 = b0 * q + b1 * r, l2 = b2 * p + b3 * q, l3 = b2 * q + b3 * r;
            double *to = m->D[of->row[e]], *z = m->y[of->row[e]];
            to[0] -= l0 * b0 + l1 * b1;
            to[1] -= l2 * b0 + l3 * b1;
            to[2] -= l2 * b2 + l3 * b3;
            z[0] -= b0 * y0 + b1 * y1;
            z[1] -= b2 * y0 + b3 * y1;
            if (e) {
                double *S = m->S[of->target];
                S[0] -= l0 * c0 + l1 * c1;
                S[1] -= l0 * c2 + l1 * c3;
                S[2] -= l2 * c0 + l3 * c1;
                S[3] -= l2 * c2 + l3 * c3;
            }
            c0 = b0, c1 = b1, c2 = b2, c3 = b3;
        }
    }
}

static void forward(bars *m)
{
    for (int k = 0; k < m->pins; k++) {
        const pin *of = m->pin + k;
        const double *D = m->D[k], *B = m->S[of->at];
        double *y = m->y[k];
        const double y0 = D[0] * y[0] + D[1] * y[1], y1 = D[1] * y[0] + D[2] * y[1];
        y[0] = y0, y[1] = y1;
        for (int e = 0; e < of->below; e++, B += 4) {
            double *z = m->y[of->row[e]];
            z[0] -= B[0] * y0 + B[1] * y1;
            z[1] -= B[2] * y0 + B[3] * y1;
        }
    }
}

static void backward(bars *m)
{
    for (int k = m->pins - 1; k >= 0; k--) {
        const pin *of = m->pin + k;
        const double *D = m->D[k], *B = m->S[of->at];
        double x0 = 0, x1 = 0;
        for (int e = 0; e < of->below; e++, B += 4) {
            const double *z = m->y[of->row[e]];
            x0 += B[0] * z[0] + B[2] * z[1];
            x1 += B[1] * z[0] + B[3] * z[1];
        }
        m->y[k][0] -= D[0] * x0 + D[1] * x1;
        m->y[k][1] -= D[1] * x0 + D[2] * x1;
    }
}

/* x <- x - W C^T y; nothing is written to the ground, for which all would wait. */
static void subtract_stored(const bars *m, double *x)
{
    for (int k = 0; k < m->pins; k++) {
        const double y0 = m->y[k][0], y1 = m->y[k][1], *X = m->CW[k][0], *Y = m->CW[k][1];
        double *a = x + 3 * m->pin[k].body[0], *b = x + 3 * m->pin[k].body[1];
        for (int i = 0; i < 3; i++) b[i] -= Y[i] * y0 + Y[3 + i] * y1;
        for (int i = 0; m->pin[k].body[0] && i < 3; i++) a[i] -= X[i] * y0 + X[3 + i] * y1;
    }
}

static void subtract(const bars *m, double *x)
{
    if (m->is_stored) {
        subtract_stored(m, x);
        return;
    }
    for (int k = 0; k < m->pins; k++) {
        const int first = m->pin[k].body[0], second = m->pin[k].body[1];
        const double y0 = m->y[k][0], y1 = m->y[k][1], *u = m->arm[k][0], *w = m->arm[k][1], *A = m->per[first], *B = m->per[second];
        double *a = x + 3 * first, *b = x + 3 * second;
        b[0] += B[0] * y0;
        b[1] += B[1] * y1;
        b[2] += B[2] * (w[0] * y1 - w[1] * y0);
        if (!first) continue;
        a[0] -= A[0] * y0;
        a[1] -= A[1] * y1;
        a[2] -= A[2] * (u[0] * y1 - u[1] * y0);
    }
}

/* ---- a step ---- */

static void accelerate(bars *m, const double *p, const double *v, double *a)
{
    for (int b = 0; b < m->bodies; b++) a[3 * b] = a[3 * b + 2] = 0, a[3 * b + 1] = b ? -GRAVITY : 0;
    if (!m->has_factors) {
        turn(m, p);
        assemble(m);
        right_side(m, a, v);
        factor(m);
    } else {
        right_side(m, a, v);
        forward(m);
    }
    m->has_factors = 0;
    backward(m);
    subtract(m, a);                                                         /* (13) */
}

static void integrate(bars *m, double *restrict p, double *restrict v)
{
    const int n = 3 * m->bodies;
    double *restrict k1 = m->state[0], *restrict k2 = m->state[1], *restrict k3 = m->state[2], *restrict k4 = m->state[3];
    double *restrict q = m->state[4], *restrict v2 = m->state[5], *restrict v3 = m->state[6], *restrict v4 = m->state[7];
    accelerate(m, p, v, k1);
    for (int i = 0; i < n; i++) q[i] = p[i] + STEP / 2 * v[i], v2[i] = v[i] + STEP / 2 * k1[i];
    accelerate(m, q, v2, k2);
    for (int i = 0; i < n; i++) q[i] = p[i] + STEP / 2 * v2[i], v3[i] = v[i] + STEP / 2 * k2[i];
    accelerate(m, q, v3, k3);
    for (int i = 0; i < n; i++) q[i] = p[i] + STEP * v3[i], v4[i] = v[i] + STEP * k3[i];
    accelerate(m, q, v4, k4);
    for (int i = 0; i < n; i++) {
        p[i] += STEP / 6 * (v[i] + 2 * (v2[i] + v3[i]) + v4[i]);
        v[i] += STEP / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
}

static double correct(bars *m, double *p, double *v)
{
    double left;
    for (int i = 0;; i++) {
        turn(m, p);
        left = violation(m, p);
        if (i == 10 || (i && left < 1e-12)) break;
        assemble(m);
        factor(m);
        backward(m);
        subtract(m, p);                                                     /* (27a) */
    }
    assemble(m);
    right_side(m, v, NULL);
    factor(m);
    backward(m);
    subtract(m, v);                                                         /* (27b) */
    m->has_factors = 1;
    return left;
}

static void draw(const bars *m, int n, double *p)
{
    const double c = cos(ANGLE), s = sin(ANGLE);
    for (int i = 0; i <= n; i++) {
        memcpy(p + 3 * (1 + 2 * i), (double[]){i + c / 2, s / 2, ANGLE}, 3 * sizeof *p);
        if (i < n) memcpy(p + 3 * (2 + 2 * i), (double[]){i + 0.5 + c, s, 0}, 3 * sizeof *p);
    }
    (void)m;
}

/* ---- what is reported ---- */

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void measure(int n, int is_stored)
{
    const int steps = n > 3000 ? 20 : n > 300 ? 50 : n < 10 ? 1000 : 100, rounds = n > 3000 ? 10 : 60;
    bars *m = create(n, is_stored);
    double best = INFINITY, left = 0, *p = take(3 * m->bodies, sizeof *p), *v = take(3 * m->bodies, sizeof *v);
    draw(m, n, p);
    for (int round = 0; round < rounds; round++) {
        const double start = seconds();
        for (int step = 0; step < steps; step++) {
            integrate(m, p, v);
            left = correct(m, p, v);
        }
        best = fmin(best, (seconds() - start) / steps);
    }
    printf("%s %d %.4f microseconds, Phi %.0e m, crank angles %.0e rad apart\n", is_stored ? "blocks" : "bodies", n, best * 1e6, left,
           fabs(p[5] - p[3 * (1 + 2 * n) + 2]));
    free(p);
    free(v);
    release(m);
}

int main(int count, char **numbers)
{
    for (int is_stored = 0; is_stored < 2; is_stored++)
        for (int i = 1; i < count; i++) measure(atoi(numbers[i]), is_stored);
    return 0;
}
