/* Rows of many entries made orthogonal to each other, in their order. */
#ifndef ZD_ORTHOGONAL_H
#define ZD_ORTHOGONAL_H

typedef struct zd_orthogonal {
    int n, m;
    const double *C;        /* (m, n): the rows */
    const double *L;        /* (n, n): as zd_cholesky() leaves it, of the matrix whose inverse is their metric; NULL: the plain metric */
    double *Q;              /* (m, n): rows with C = G Q in the plain metric, C L^-T = G Q else; the last ones when called */
    double *G;              /* (m, m): below its diagonal of ones, in place of which are the inverse squares of the rows of Q */
    double *square;         /* (m,): of the rows of C, in their metric */
    double *rows;           /* (4, n): those being worked on */
    double *weighted;       /* (n,) */
} zd_orthogonal;

typedef struct zd_shares {
    int rows;               /* m, or the first row of which less than asked for is left when those before it are taken out */
    double least;           /* of what is left of a row, squared, its share in all of it */
    double turned;          /* the sum of the squared sines by which rows of Q have turned; infinite where one has by a right angle */
} zd_shares;

/* `enough`: the share, squared, of a row that has to be left. */
zd_shares zd_orthogonalize(const zd_orthogonal *self, double enough);

#endif
