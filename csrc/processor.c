/* Widest vector unit that the processor has and the operating system supports.
 *
 * The CPUID instruction is executed directly: the compilers' functions read a variable of their own libraries, which is zero with zig.
 * Bits are numbered as in Intel's Software Developer's Manual, volume 2, CPUID, and volume 1, 13.3 for XCR0. In a virtual machine one
 * CPUID takes a microsecond or more: if that variable already reports a unit, CPUID is not executed when a run is created.
 */
#include "zerodrift.h"

#if defined(__GNUC__) && defined(__x86_64__)
#include <cpuid.h>

#define BIT(number) (1u << (number))

enum { LEAF_OF_AVX = 1, LEAF_OF_AVX2 = 7, FMA = 12, READS_XCR0 = 27, AVX2 = 5, AVX512F = 16, AVX512DQ = 17, AVX512VL = 31 };

static int has_all(unsigned word, unsigned bits)
{
    return (word & bits) == bits;
}

/* Registers that the operating system saves per thread: the lower half of XCR0. */
static unsigned saved_registers(void)
{
    unsigned low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

enum zd_unit zd_processor_unit(void)
{
    const unsigned of_avx = BIT(1) | BIT(2), of_avx512 = of_avx | BIT(5) | BIT(6) | BIT(7);
    unsigned a, b, c, d, ignored;
    if (!__get_cpuid(LEAF_OF_AVX, &a, &b, &c, &d) || !has_all(c, BIT(FMA) | BIT(READS_XCR0))) return ZD_BASELINE;
    unsigned saved = saved_registers();
    if (!has_all(saved, of_avx)) return ZD_BASELINE;
    if (!__get_cpuid_count(LEAF_OF_AVX2, 0, &a, &b, &ignored, &d) || !has_all(b, BIT(AVX2))) return ZD_BASELINE;
#ifdef __APPLE__
    saved |= of_avx512;         /* which macOS saves once they have been used, and says so only then */
#endif
    return has_all(saved, of_avx512) && has_all(b, BIT(AVX512F) | BIT(AVX512DQ) | BIT(AVX512VL)) ? ZD_AVX512 : ZD_AVX2;
}

/* As the compiler's library has found when it was loaded; baseline: there is none, or it does not know. */
static enum zd_unit known_unit(void)
{
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return ZD_BASELINE;
    const int has_512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return has_512 ? ZD_AVX512 : ZD_AVX2;
}

int zd_processor_has(enum zd_unit unit)
{
    return unit <= known_unit() || unit <= zd_processor_unit();
}

#else

enum zd_unit zd_processor_unit(void)
{
    return ZD_BASELINE;
}

int zd_processor_has(enum zd_unit unit)
{
    return unit == ZD_BASELINE;
}

#endif
