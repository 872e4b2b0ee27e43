/* The sines of reduced angles, for one type of numbers: <zerodrift/sines.h> includes this for double, <zerodrift/lanes.h> for vectors.
 *
 *     ZD_OF_TYPE(name)        the name of a function or type for this type of numbers
 *     ZD_REAL, ZD_WORDS       the type, and that of unsigned integers of 64 bits beside it
 *     ZD_INLINED               how functions are declared
 *     ZD_WORDS_OF(x), ZD_REAL_OF(w)   the bits of numbers, and numbers of such bits
 *     ZD_TIMES_PLUS(a, b, c)  a b + c, and
 *     ZD_LESS_TIMES(c, a, b)  c - a b, rounded once or twice
 *
 * Reductions and polynomials are explained there.
 */

/* An angle is quadrant pi/2 + r + tail, where |r| is at most pi/4 and a little, and the tail is below the last place of r. */
typedef struct ZD_OF_TYPE(zd_reduced) {
    ZD_REAL r, tail;
    ZD_WORDS quadrant;      /* the last two bits count */
} ZD_OF_TYPE(zd_reduced);

/* Sine and cosine by Remez' polynomials in z = r^2, which are 2^-58 and 2^-64 off. What is rounded last is r or 1 - z/2 and something
 * that is small beside it. The sine is written as a difference, as -0 - 0 is -0, but -0 + 0 is not. */
ZD_INLINED void ZD_OF_TYPE(zd_sines_of_reduced)(const ZD_OF_TYPE(zd_reduced) *a, ZD_REAL *s, ZD_REAL *c)
{
    ZD_REAL r = a->r, z = r * r, z2 = z * z, z4 = z2 * z2, half = 0.5 * z, w = 1 - half;
    ZD_REAL S = ZD_TIMES_PLUS(z4, ZD_TIMES_PLUS(z, 0x1.5d9300cf18812p-33, -0x1.ae5e6639d428fp-26),
                              ZD_TIMES_PLUS(z2, ZD_TIMES_PLUS(z, 0x1.71de3577b56b1p-19, -0x1.a01a019c11978p-13),
                                            ZD_TIMES_PLUS(z, 0x1.111111110f87ap-7, -0x1.5555555555549p-3)));
    ZD_REAL C = ZD_TIMES_PLUS(z4, ZD_TIMES_PLUS(z, -0x1.8fae9cb4449ffp-37, 0x1.1ee9ebe9aae80p-29),
                              ZD_TIMES_PLUS(z2, ZD_TIMES_PLUS(z, -0x1.27e4f809f15ecp-22, 0x1.a01a019cb1bebp-16),
                                            ZD_TIMES_PLUS(z, -0x1.6c16c16c1517ep-10, 0x1.555555555554cp-5)));
    ZD_REAL sine = r - ZD_LESS_TIMES(ZD_TIMES_PLUS(half, a->tail, -a->tail), r * z, S);
    ZD_REAL cosine = w + ZD_TIMES_PLUS(z2, C, ZD_LESS_TIMES((1 - w) - half, r, a->tail));     /* C is known last */
    ZD_WORDS odd = 0 - (a->quadrant & 1), u = ZD_WORDS_OF(sine), v = ZD_WORDS_OF(cosine);
    *s = ZD_REAL_OF(((u & ~odd) | (v & odd)) ^ (a->quadrant & 2) << 62);
    *c = ZD_REAL_OF(((v & ~odd) | (u & odd)) ^ ((a->quadrant + 1) & 2) << 62);
}

/* Reduction of |x| <= 2^19: products with the first three parts of pi/2, of 33 bits each, are exact, as are the errors of differences. */
ZD_INLINED void ZD_OF_TYPE(zd_reduce_moderate)(ZD_REAL x, ZD_OF_TYPE(zd_reduced) *a)
{
    /* k, next to x 2/pi, is in its last bits */
    ZD_REAL shifted = ZD_TIMES_PLUS(x, 0x1.45f306dc9c883p-1, 0x1.8p52), k = shifted - 0x1.8p52;
    ZD_REAL first = ZD_LESS_TIMES(x, k, 0x1.921fb544p+0);
    ZD_REAL b = k * 0x1.0b4611a6p-34, second = first - b;
    ZD_REAL c = k * 0x1.3198a2ep-69;
    a->r = second - c;
    a->tail = ZD_LESS_TIMES(((first - second) - b) + ((second - a->r) - c), k, 0x1.b839a252049c1p-104);
    a->quadrant = ZD_WORDS_OF(shifted);
}
