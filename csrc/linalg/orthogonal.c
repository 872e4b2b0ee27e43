/* Modified Gram-Schmidt orthogonalization: the components along earlier rows are removed from each row one by one, and once more if the
 * residual norm is small.
 *
 * Four rows are processed together, so that their sums overlap in the processor. In the metric of D^-1, with C L^-T = G Q, the rows of Q
 * give G E G^T = C M^-1 C^T, see formulations/schur.c. Each row of Q is compared with that of the previous call: its direction changes
 * abruptly when a constraint passes through dependence on earlier ones, and slowly otherwise.
 */
#include "dense.h"

#include "small.h"

enum { TOGETHER = 4 };
static const double LITTLE = 0.01;      /* squared relative residual norm below which a row is orthogonalized twice, which is enough */

/* to <- D^-1 q */
static void weigh(const zd_orthogonal *self, const double *q, double *to)
{
    const int n = self->n;
    if (self->L)
        for (int i = 0; i < n; i++) to[i] = self->L[i * n + i] * q[i];
    else zd_copy(n, q, to);
}

static double square_of(const zd_orthogonal *self, const double *q)
{
    return self->L ? zd_metric_dot(self->n, self->L, q, q) : zd_dot(self->n, q, q);
}

/* Removes the components along row j of Q from `count` rows, from row k on. */
static void take_out(const zd_orthogonal *self, int j, int k, int count, double *rows)
{
    const int n = self->n, m = self->m;
    const double *q = self->Q + j * n;
    double *weighted = self->weighted, dots[TOGETHER];
    weigh(self, q, weighted);
    if (count == TOGETHER) zd_four_dots(n, rows, n, weighted, dots);
    else
        for (int r = 0; r < count; r++) dots[r] = zd_dot(n, weighted, rows + r * n);
    for (int r = 0; r < count; r++) {
        double along = self->G[(k + r) * m + j] = self->G[j * m + j] * dots[r];
        zd_add_scaled(n, rows + r * n, -along, q);
    }
}

static double take_out_again(const zd_orthogonal *self, int k, double *row)
{
    const int n = self->n, m = self->m;
    double *weighted = self->weighted;
    for (int j = 0; j < k; j++) {
        weigh(self, self->Q + j * n, weighted);
        double along = self->G[j * m + j] * zd_dot(n, weighted, row);
        self->G[k * m + j] += along;
        zd_add_scaled(n, row, -along, self->Q + j * n);
    }
    return square_of(self, row);
}

/* Squared sine of the angle between two versions of a row of Q, the earlier one `was` and the new one `is`, whose squared norm is
 * `square`; infinity if they are more than a right angle apart. */
static double turn(const zd_orthogonal *self, const double *was, const double *is, double square)
{
    double *weighted = self->weighted;
    weigh(self, is, weighted);
    double along = zd_dot(self->n, weighted, was), product = square * square_of(self, was);
    return along > 0 && product < INFINITY ? 1 - along * along / product : INFINITY;
}

/* Completes row k of Q: subtracts its components along the rows before it in its own group of four; those along earlier groups have been
 * subtracted. Returns 1 if its squared norm is then more than `enough` of that of the row given, 0 if the row is dependent. */
static int finish(const zd_orthogonal *self, int k, double *row, double enough, zd_shares *shares)
{
    const int n = self->n, m = self->m;
    const double square = self->square[k];
    for (int j = k - k % TOGETHER; j < k; j++) take_out(self, j, k, 1, row);
    double rest = k ? square_of(self, row) : square;
    if (rest < LITTLE * square) rest = take_out_again(self, k, row);
    if (!(rest > enough * square) || !(rest < INFINITY)) return 0;
    self->G[k * m + k] = 1 / rest;
    shares->least = fmin(shares->least, rest / square);
    shares->turned += turn(self, self->Q + k * n, row, rest);
    zd_copy(n, row, self->Q + k * n);
    return 1;
}

zd_shares zd_orthogonalize(const zd_orthogonal *self, const double *C, double enough)
{
    const int n = self->n, m = self->m;
    zd_shares shares = {m, 1, 0};
    for (int k = 0; k < m; k += TOGETHER) {
        const int count = k + TOGETHER <= m ? TOGETHER : m - k;
        if (self->L) zd_forward_rows(n, count, self->L, C + k * n, self->rows);
        else zd_copy(count * n, C + k * n, self->rows);
        for (int r = 0; r < count; r++) self->square[k + r] = square_of(self, self->rows + r * n);
        for (int j = 0; j < k; j++) take_out(self, j, k, count, self->rows);
        for (int r = 0; r < count; r++) {
            if (finish(self, k + r, self->rows + r * n, enough, &shares)) continue;
            shares.rows = k + r;
            return shares;
        }
    }
    return shares;
}
