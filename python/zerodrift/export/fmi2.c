/* Co-simulation by FMI 2.0, https://fmi-standard.org/docs/2.0/. Signatures are those of the standard. */
#include "fmu.h"

typedef void logger(void *environment, const char *name, int status, const char *category, const char *message, ...);

typedef struct callbacks {
    logger *log;
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*finished)(void *, int);
    void *environment;
} callbacks;

static void log_error(fmu *self, int status)
{
    logger *callback;
    memcpy(&callback, &self->callback, sizeof callback);
    if (callback) callback(self->environment, self->name, status, "logStatusError", "%s", self->message);
}

FMU_EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
FMU_EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

FMU_EXPORT int fmi2SetDebugLogging(void *instance, int on, size_t count, const char *const categories[])
{
    (void)instance, (void)on, (void)count, (void)categories;
    return FMU_OK;
}

FMU_EXPORT void *fmi2Instantiate(const char *name, int kind, const char *token, const char *resources, const callbacks *given, int visible,
                                 int logging)
{
    (void)resources, (void)visible, (void)logging;
    fmu *self = kind == 1 ? fmu_create(name) : NULL;        /* 1: co-simulation */
    if (!self) return NULL;
    self->environment = given->environment;
    self->log = log_error;
    memcpy(&self->callback, &given->log, sizeof self->callback);
    if (!strcmp(token, TOKEN) && !fmu_begin(self)) return self;
    if (strcmp(token, TOKEN)) fmu_refuse(self, "the GUID must be that of the model description");
    fmu_free(self);
    return NULL;
}

FMU_EXPORT void fmi2FreeInstance(void *instance) { fmu_free(instance); }

FMU_EXPORT int fmi2SetupExperiment(void *instance, int has_tolerance, double tolerance, double start, int has_stop, double stop)
{
    fmu *self = instance;
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    self->start = start;
    return FMU_OK;
}

FMU_EXPORT int fmi2EnterInitializationMode(void *instance) { return (void)instance, FMU_OK; }
FMU_EXPORT int fmi2ExitInitializationMode(void *instance) { return fmu_initialize(instance); }
FMU_EXPORT int fmi2Terminate(void *instance) { return (void)instance, FMU_OK; }
FMU_EXPORT int fmi2Reset(void *instance) { return fmu_begin(instance); }

FMU_EXPORT int fmi2GetReal(void *instance, const uint32_t reference[], size_t count, double values[])
{
    return fmu_get(instance, reference, count, values);
}

FMU_EXPORT int fmi2SetReal(void *instance, const uint32_t reference[], size_t count, const double values[])
{
    return fmu_set(instance, reference, count, values);
}

FMU_EXPORT int fmi2DoStep(void *instance, double t, double size, int no_set)
{
    (void)no_set;
    fmu *self = instance;
    const int status = fmu_step(self, t, size);
    if (status || self->event < 0) return status;
    snprintf(self->message, sizeof self->message, "%s", zd_opened_message(self->opened));
    self->log(self, FMU_DISCARD);
    return FMU_DISCARD;
}

FMU_EXPORT int fmi2GetRealStatus(void *instance, int kind, double *value)
{
    fmu *self = instance;
    if (kind != 2) return FMU_DISCARD;      /* 2: the last successful time */
    *value = zd_run_time(zd_opened_run(self->opened));
    return FMU_OK;
}

FMU_EXPORT int fmi2GetBooleanStatus(void *instance, int kind, int *value)
{
    const fmu *self = instance;
    if (kind != 3) return FMU_DISCARD;      /* 3: the simulation is to end */
    *value = self->event >= 0;
    return FMU_OK;
}

FMU_EXPORT int fmi2GetFMUstate(void *instance, void **state) { return fmu_save(instance, state); }
FMU_EXPORT int fmi2SetFMUstate(void *instance, void *state) { return fmu_restore(instance, state); }
FMU_EXPORT int fmi2FreeFMUstate(void *instance, void **state) { return (void)instance, fmu_release(state); }

FMU_EXPORT int fmi2SerializedFMUstateSize(void *instance, void *state, size_t *size) { return fmu_state_size(instance, state, size); }

FMU_EXPORT int fmi2SerializeFMUstate(void *instance, void *state, unsigned char bytes[], size_t size)
{
    return fmu_serialize(instance, state, bytes, size);
}

FMU_EXPORT int fmi2DeSerializeFMUstate(void *instance, const unsigned char bytes[], size_t size, void **state)
{
    return fmu_deserialize(instance, bytes, size, state);
}

/* Functions for capabilities that the model description does not declare. */
#define REFUSED(name) \
    FMU_EXPORT int name(void *instance); \
    FMU_EXPORT int name(void *instance) { return fmu_refuse(instance, #name " is not available"); }

REFUSED(fmi2GetInteger) REFUSED(fmi2GetBoolean) REFUSED(fmi2GetString) REFUSED(fmi2SetInteger) REFUSED(fmi2SetBoolean) REFUSED(fmi2SetString)
REFUSED(fmi2GetDirectionalDerivative)
REFUSED(fmi2SetRealInputDerivatives) REFUSED(fmi2GetRealOutputDerivatives) REFUSED(fmi2CancelStep) REFUSED(fmi2GetStatus)
REFUSED(fmi2GetIntegerStatus) REFUSED(fmi2GetStringStatus)
