/* Constants and starts of many systems, from their parameters. */
#include "../zerodrift.h"

static int64_t count_parameters(const zd_kind *kind)
{
    int64_t count = 0;
    for (int i = 0; i < kind->parameters; i++) count += kind->parameter[i].size;
    return count;
}

int64_t zd_batch_of_kind(const zd_kind *kind, int64_t runs, const double *parameters, double *constants, double *p0, double *v0,
                         const char **reason)
{
    const int64_t count = count_parameters(kind);
    *reason = NULL;
    for (int64_t i = 0; i < runs; i++) {
        *reason = kind->prepare(parameters + i * count, constants + i * kind->constants);
        if (*reason) return i;
        kind->start(parameters + i * count, p0 + i * kind->system.nq, v0 + i * kind->system.nv);
    }
    return runs;
}

void zd_batch_derive(void (*derive)(double *data), int64_t runs, int64_t doubles, double *data)
{
    for (int64_t i = 0; i < runs; i++) derive(data + i * doubles);
}
