/* Co-simulation by FMI 3.0, https://fmi-standard.org/docs/3.0/. Signatures are those of the standard. */
#include "fmu.h"

typedef void log_message(void *environment, int status, const char *category, const char *message);

static void log_error(fmu *self, int status)
{
    log_message *callback;
    memcpy(&callback, &self->callback, sizeof callback);
    if (callback) callback(self->environment, status, "logStatusError", self->message);
}

FMU_EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

FMU_EXPORT int fmi3SetDebugLogging(void *instance, bool on, size_t count, const char *const categories[])
{
    (void)instance, (void)on, (void)count, (void)categories;
    return FMU_OK;
}

FMU_EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                             bool events, bool early, const uint32_t intermediate[], size_t count, void *environment,
                                             log_message *log, void (*update)(void))
{
    (void)resources, (void)visible, (void)logging, (void)events, (void)intermediate, (void)count, (void)update;
    fmu *self = fmu_create(name);
    if (!self) return NULL;
    self->environment = environment;
    self->returns_early = early;
    self->log = log_error;
    memcpy(&self->callback, &log, sizeof self->callback);
    if (!strcmp(token, TOKEN) && !fmu_begin(self)) return self;
    if (strcmp(token, TOKEN)) fmu_refuse(self, "the instantiation token must be that of the model description");
    fmu_free(self);
    return NULL;
}

FMU_EXPORT void fmi3FreeInstance(void *instance) { fmu_free(instance); }

FMU_EXPORT int fmi3EnterInitializationMode(void *instance, bool has_tolerance, double tolerance, double start, bool has_stop, double stop)
{
    fmu *self = instance;
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    self->start = start;
    return FMU_OK;
}

FMU_EXPORT int fmi3ExitInitializationMode(void *instance) { return fmu_initialize(instance); }
FMU_EXPORT int fmi3Terminate(void *instance) { return (void)instance, FMU_OK; }
FMU_EXPORT int fmi3Reset(void *instance) { return fmu_begin(instance); }

FMU_EXPORT int fmi3GetFloat64(void *instance, const uint32_t reference[], size_t count, double values[], size_t size)
{
    return size == count ? fmu_get(instance, reference, count, values) : fmu_refuse(instance, "variables must be scalar");
}

FMU_EXPORT int fmi3SetFloat64(void *instance, const uint32_t reference[], size_t count, const double values[], size_t size)
{
    return size == count ? fmu_set(instance, reference, count, values) : fmu_refuse(instance, "variables must be scalar");
}

FMU_EXPORT int fmi3DoStep(void *instance, double t, double size, bool no_set, bool *events, bool *terminate, bool *early, double *last)
{
    (void)no_set;
    fmu *self = instance;
    int status = fmu_step(self, t, size);
    *events = *terminate = false;
    while (!status && self->event >= 0) {
        *terminate |= fmu_events(self)->terminal[self->event] != 0;
        if (self->returns_early) break;
        status = fmu_step(self, t, size);       /* the simulation is to end, but not before the end of this step */
    }
    *last = zd_run_time(zd_opened_run(self->opened));
    *early = !status && *last < t + size && self->event >= 0;
    return status;
}

FMU_EXPORT int fmi3GetFMUState(void *instance, void **state) { return fmu_save(instance, state); }
FMU_EXPORT int fmi3SetFMUState(void *instance, void *state) { return fmu_restore(instance, state); }
FMU_EXPORT int fmi3FreeFMUState(void *instance, void **state) { return (void)instance, fmu_release(state); }

FMU_EXPORT int fmi3SerializedFMUStateSize(void *instance, void *state, size_t *size) { return fmu_state_size(instance, state, size); }

FMU_EXPORT int fmi3SerializeFMUState(void *instance, void *state, unsigned char bytes[], size_t size)
{
    return fmu_serialize(instance, state, bytes, size);
}

FMU_EXPORT int fmi3DeserializeFMUState(void *instance, const unsigned char bytes[], size_t size, void **state)
{
    return fmu_deserialize(instance, bytes, size, state);
}

/* Functions for capabilities that the model description does not declare. */
#define REFUSED(name) \
    FMU_EXPORT int name(void *instance); \
    FMU_EXPORT int name(void *instance) { return fmu_refuse(instance, #name " is not available"); }
#define NONE(name) FMU_EXPORT void *name(void); FMU_EXPORT void *name(void) { return NULL; }
#define OF_TYPE(type) REFUSED(fmi3Get##type) REFUSED(fmi3Set##type)

NONE(fmi3InstantiateModelExchange) NONE(fmi3InstantiateScheduledExecution)
OF_TYPE(Float32) OF_TYPE(Int8) OF_TYPE(UInt8) OF_TYPE(Int16) OF_TYPE(UInt16) OF_TYPE(Int32) OF_TYPE(UInt32) OF_TYPE(Int64) OF_TYPE(UInt64)
OF_TYPE(Boolean) OF_TYPE(String) OF_TYPE(Binary) OF_TYPE(Clock)
REFUSED(fmi3GetNumberOfVariableDependencies) REFUSED(fmi3GetVariableDependencies) REFUSED(fmi3GetDirectionalDerivative)
REFUSED(fmi3GetAdjointDerivative) REFUSED(fmi3EnterConfigurationMode) REFUSED(fmi3ExitConfigurationMode) REFUSED(fmi3EnterEventMode)
OF_TYPE(IntervalDecimal) OF_TYPE(IntervalFraction) OF_TYPE(ShiftDecimal) OF_TYPE(ShiftFraction)
REFUSED(fmi3EvaluateDiscreteStates) REFUSED(fmi3UpdateDiscreteStates) REFUSED(fmi3EnterContinuousTimeMode) REFUSED(fmi3SetTime)
REFUSED(fmi3CompletedIntegratorStep) OF_TYPE(ContinuousStates) REFUSED(fmi3GetContinuousStateDerivatives) REFUSED(fmi3GetEventIndicators)
REFUSED(fmi3GetNominalsOfContinuousStates) REFUSED(fmi3GetNumberOfEventIndicators) REFUSED(fmi3GetNumberOfContinuousStates)
REFUSED(fmi3EnterStepMode) REFUSED(fmi3GetOutputDerivatives) REFUSED(fmi3ActivateModelPartition)
