#include "elimination_on_avx2.h"

#include "pivot.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#define ON_AVX2 __attribute__((target("avx2")))

/* Of rows (a, b), (c, d): a, a, c, c and b, b, d, d; a, c, a, c and b, d, b, d */
ON_AVX2 ZD_INLINE __m256d firsts(__m256d A) { return _mm256_movedup_pd(A); }
ON_AVX2 ZD_INLINE __m256d seconds(__m256d A) { return _mm256_permute_pd(A, 0xf); }
ON_AVX2 ZD_INLINE __m256d first_column(__m256d A) { return _mm256_permute4x64_pd(A, 0x88); }
ON_AVX2 ZD_INLINE __m256d second_column(__m256d A) { return _mm256_permute4x64_pd(A, 0xdd); }

/* A B, of B its rows, each twice */
ON_AVX2 ZD_INLINE __m256d product(__m256d A, __m256d first_row, __m256d second_row)
{
    return _mm256_add_pd(_mm256_mul_pd(firsts(A), first_row), _mm256_mul_pd(seconds(A), second_row));
}

/* to <- to - A B^T, of B its columns, each twice */
ON_AVX2 ZD_INLINE void subtract(__m256d A, __m256d first_column, __m256d second_column, double *to)
{
    _mm256_storeu_pd(to, _mm256_sub_pd(_mm256_loadu_pd(to), product(A, first_column, second_column)));
}

ON_AVX2 void zd_eliminate_on_avx2(const zd_blocks *self, zd_pivots *pivots)
{
    zd_pivots found = *pivots;              /* in registers */
    const int *target = self->target, *begin = self->begin, *row = self->row, count = self->count;
    double *S = self->S, *pivot = S, *entry = S + 4 * count;
    for (int k = 0; k < count; k++, pivot += 4) {
        const zd_inverse_of_two of = zd_invert_two(self->diagonal + 2 * k, 2 * k, pivot, &found);
        const __m256d P = _mm256_set_pd(of.bb, of.ab, of.ab, of.aa);
        const __m256d p0 = _mm256_permute2f128_pd(P, P, 0), p1 = _mm256_permute2f128_pd(P, P, 0x11);
        const double *before = entry, *end = entry + 4 * (begin[k + 1] - begin[k]);
        _mm256_storeu_pd(pivot, P);
        for (; entry < end; entry += 4) {
            const __m256d B = _mm256_loadu_pd(entry), L = product(B, p0, p1);
            for (const double *other = before; other < entry; other += 4) {
                const __m256d of_other = _mm256_loadu_pd(other);
                subtract(B, first_column(of_other), second_column(of_other), S + *target++);
            }
            subtract(L, first_column(B), second_column(B), S + 4 * *row++);
            _mm256_storeu_pd(entry, L);
        }
    }
    *pivots = found;
}

/* A (x, y), of x and y twice, one after the other */
ON_AVX2 ZD_INLINE __m128d times(const double *A, __m256d xy)
{
    const __m256d terms = _mm256_mul_pd(_mm256_loadu_pd(A), xy);
    return _mm_hadd_pd(_mm256_castpd256_pd128(terms), _mm256_extractf128_pd(terms, 1));
}

/* A^T (x, y), of x twice and then y */
ON_AVX2 ZD_INLINE __m128d times_transposed(const double *A, __m256d xxyy)
{
    const __m256d terms = _mm256_mul_pd(_mm256_loadu_pd(A), xxyy);
    return _mm_add_pd(_mm256_castpd256_pd128(terms), _mm256_extractf128_pd(terms, 1));
}

ON_AVX2 void zd_solve_on_avx2(const zd_blocks *self, double *x)
{
    const int *begin = self->begin, *row = self->row, count = self->count;
    const double *pivot = self->S, *entry = pivot + 4 * count;
    for (int k = 0, e = 0; k < count; k++, pivot += 4) {
        const __m128d own = _mm_loadu_pd(x + 2 * k);
        const __m256d twice = _mm256_set_m128d(own, own);
        for (const int end = begin[k + 1]; e < end; e++, entry += 4) {
            double *y = x + 2 * row[e];
            _mm_storeu_pd(y, _mm_sub_pd(_mm_loadu_pd(y), times(entry, twice)));
        }
        _mm_storeu_pd(x + 2 * k, times(pivot, twice));
    }
    for (int k = count - 1; k >= 0; k--) {
        const int first = begin[k], end = begin[k + 1];
        __m128d sum = _mm_loadu_pd(x + 2 * k);
        entry = self->S + 4 * (count + first);
        for (int e = first; e < end; e++, entry += 4) {
            const __m256d y = _mm256_castpd128_pd256(_mm_loadu_pd(x + 2 * row[e]));
            sum = _mm_sub_pd(sum, times_transposed(entry, _mm256_permute4x64_pd(y, 0x50)));
        }
        _mm_storeu_pd(x + 2 * k, sum);
    }
}

#endif
