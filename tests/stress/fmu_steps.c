/* Steps the library of an FMU (FMI 3.0) with one input and one output, and prints the output: LIBRARY TOKEN STEP STEPS INPUT. */
#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef void *instantiate(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t, void *,
                          void (*)(void *, int, const char *, const char *), void (*)(void));
typedef int enter(void *, bool, double, double, bool, double);
typedef int leave(void *);
typedef int access(void *, const uint32_t *, size_t, double *, size_t);
typedef int advance(void *, double, double, bool, bool *, bool *, bool *, double *);

static void print(void *environment, int status, const char *category, const char *message)
{
    (void)environment, (void)status;
    fprintf(stderr, "%s: %s\n", category, message);
}

int main(int count, char **words)
{
    void *library = count == 6 ? dlopen(words[1], RTLD_NOW) : NULL;
    if (!library) return fprintf(stderr, "%s\n", dlerror()), 1;
    instantiate *create = (instantiate *)dlsym(library, "fmi3InstantiateCoSimulation");
    advance *step = (advance *)dlsym(library, "fmi3DoStep");
    const double size = atof(words[3]);
    const int steps = atoi(words[4]);
    double input = atof(words[5]), output, last;
    bool event, end, early;
    void *unit = create("unit", words[2], NULL, false, true, false, false, NULL, 0, NULL, print, NULL);
    int status = !unit || ((enter *)dlsym(library, "fmi3EnterInitializationMode"))(unit, false, 0, 0, false, 0);
    if (!status) status = ((access *)dlsym(library, "fmi3SetFloat64"))(unit, (uint32_t[]){1}, 1, &input, 1);
    if (!status) status = ((leave *)dlsym(library, "fmi3ExitInitializationMode"))(unit);
    for (int i = 0; !status && i < steps; i++) status = step(unit, i * size, size, true, &event, &end, &early, &last);
    if (!status) status = ((access *)dlsym(library, "fmi3GetFloat64"))(unit, (uint32_t[]){2}, 1, &output, 1);
    if (!status) printf("%.17g\n", output);
    return status;
}
