/* The pivots of C C^T are the squares of what is left of each row once those before it are taken out. Rounding leaves them off by 2^-52 of
 * the row's square times a small number, and the shares that are asked for are 2^-20 and 2^-12.
 */
#include "packed.h"

#include "../linalg/small.h"
#include "../point/gram.h"
#include "../point/matrices.h"
#include "look.h"

static const double DOUBTFUL = ZD_DOUBTFUL * ZD_DOUBTFUL, ILL = ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;

int zd_packed_rows_are_doubtful(zd_point *point)
{
    zd_rank *self = point->rank;
    const int m = self->m;
    double *G = self->look->close.G, *squares = self->look->close.square;
    self->was_turned = 1;
    zd_gram(point->layout, point->terms.C, NULL, G);
    for (int k = 0; k < m; k++) {
        double square = squares[k] = G[k * m + k];
        if (!(square > DOUBTFUL * self->start_square[k])) return self->was_ill_conditioned = 1;
        self->was_ill_conditioned |= !(square > ILL * self->start_square[k]);
    }
    int factored = ZD_SIZED(zd_cholesky, m, G, G);
    for (int k = 0; k < factored; k++) {
        double left = 1 / G[k * m + k];
        self->was_ill_conditioned |= !(left > ILL * squares[k]);
        if (!(left > DOUBTFUL * squares[k])) return 1;
    }
    return factored < m;
}
