/* Orthogonalization of the rows of a matrix, in their order. */
#ifndef ZD_ORTHOGONAL_H
#define ZD_ORTHOGONAL_H

typedef struct zd_orthogonal {
    int n, m;
    const double *C;        /* (m, n): the rows */
    const double *L;        /* (n, n): factors by zd_cholesky() of the matrix whose inverse is the metric; NULL: Euclidean metric */
    double *Q;              /* (m, n): orthogonal rows, C = G Q in the Euclidean metric, otherwise C L^-T = G Q; input: the previous ones */
    double *G;              /* (m, m): unit lower triangular; its diagonal stores the inverse squared norms of the rows of Q */
    double *square;         /* (m,): squared norms of the rows of C, in the metric */
    double *rows;           /* (4, n): rows in process */
    double *weighted;       /* (n,) temporary */
} zd_orthogonal;

typedef struct zd_shares {
    int rows;               /* m, or the first row whose squared relative residual norm is below `enough` */
    double least;           /* smallest squared relative residual norm: |row of Q|^2 / |row of C|^2 */
    double turned;          /* sum of sin^2 of the angles between rows of Q and the previous ones; infinite at a right angle */
} zd_shares;

/* `enough`: squared relative residual norm that each row must have. */
zd_shares zd_orthogonalize(const zd_orthogonal *self, double enough);

#endif
