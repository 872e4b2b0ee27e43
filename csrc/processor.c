/* Which vector unit the processor has, and its system lets it use. */
#include "zerodrift.h"

enum zd_unit zd_processor_unit(void)
{
#if defined(__GNUC__) && defined(__x86_64__)
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return ZD_BASELINE;
    int has_512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return has_512 ? ZD_AVX512 : ZD_AVX2;
#else
    return ZD_BASELINE;
#endif
}
