/* Declarations of the extension module besides zerodrift.h: fingerprints of its sources, and systems written in Python.
 *
 * Declarations only: CFFI reads this text after the preprocessor. Functions marked ZD_WRITTEN_IN_PYTHON are implemented there.
 */
#pragma once

#include <stddef.h>

#include "../block/block.h"
#include "../mechanisms/common/assembly/given.h"
#include "../mechanisms/plane/assembly/varied.h"
#include "../mechanisms/space_tree/tree.h"
#include "../zerodrift.h"

#define ZD_WRITTEN_IN_PYTHON static

extern const char *const zd_fingerprint;
extern const char *const zd_layout;     /* memory of runs */

typedef struct zd_python_term {     /* Python's memory of one term */
    int term;                       /* its bit */
    size_t offset;                  /* offset of its pointer in zd_terms, bytes */
    size_t size;                    /* bytes */
    const double *values;
} zd_python_term;

/* A system written in Python: data of zd_evaluate_in_python(). Python does not access the core's memory. */
typedef struct zd_python {
    void *evaluator;                /* handle of the Python object */
    const zd_system *system;
    double *p, *v;                  /* (nq,), (nv,): the state of the last call, for Python to read */
    int terms;
    const zd_python_term *term;
} zd_python;

int zd_evaluate_in_python(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out);
ZD_WRITTEN_IN_PYTHON int zd_write_in_python(void *evaluator, int want, double t, int moved);
ZD_WRITTEN_IN_PYTHON int zd_refuse_in_python(void *evaluator, int term, double t);
ZD_WRITTEN_IN_PYTHON int zd_event_in_python(void *owner, int event, double t, const double *p, const double *v, const double *x,
                                            double *value);
ZD_WRITTEN_IN_PYTHON int zd_law_in_python(void *owner, int law, double t, const double *x, const double *xdot, double *out);
ZD_WRITTEN_IN_PYTHON int zd_interrupted_in_python(void *owner);
ZD_WRITTEN_IN_PYTHON void zd_name_row_in_python(const void *names, int row, char *to, int size);
ZD_WRITTEN_IN_PYTHON int zd_found_in_python(void *owner, int event, double t, const double *p, const double *v);
