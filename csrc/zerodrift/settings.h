/* Settings of a run, with its events, outputs and inputs: part of zerodrift.h. */
#ifndef ZERODRIFT_SETTINGS_H
#define ZERODRIFT_SETTINGS_H

#include "../include/zerodrift/system.h"
#include "tables.h"

/* ---- events: instants at which a function of the motion passes through zero ---- */

/* Source of an argument of an event function: a quantity of the motion, or a constant. */
enum zd_source {
    ZD_READS_TIME, ZD_READS_P, ZD_READS_V, ZD_READS_MEASURE, ZD_READS_NUMBER,
    ZD_READS_GROUP,         /* margin of a group of constraints that switch, while its phase lasts; of the core alone */
    ZD_READS_MULTIPLIER     /* multiplier of a constraint; of one that is not active, 0 */
};

typedef struct zd_argument {
    enum zd_source what;
    int index;              /* entry of p or v, or index of a measure or a group */
    int component;          /* component of the measure */
    double number;          /* value of ZD_READS_NUMBER */
} zd_argument;

/* Event function of quantities x that the core reads: zero of function(x) - value, or of zd_events.evaluate(). */
typedef struct zd_event {
    int readings;           /* number of arguments; 0: zd_events.evaluate() is called without any */
    const zd_argument *reading;  /* (readings,) the arguments x */
    const struct zd_expressions *function;  /* Expression of x, in csrc/laws/program.h; NULL: x[0] itself */
    double value;           /* the event occurs when the function passes through this value */
    int is_called;          /* true: zd_events.evaluate() is called with x, and the two above are not used */
} zd_event;

/* Action at each occurrence of an event, after which the run goes on: an input is set, or the caller acts, see zd_run_acting(). */
enum { ZD_CALLER_ACTS = -1, ZD_CHANGES_PHASE = -2, ZD_SWITCHES = -3 };
typedef struct zd_action {
    int event;
    int input;              /* index; ZD_CALLER_ACTS; ZD_SWITCHES - g: the two-sided group g is joined as it stands, or with the value 0
                             * released; ZD_CHANGES_PHASE of the core alone */
    double value;           /* value of the input */
} zd_action;

typedef struct zd_events {
    int count;
    const int *direction;   /* (count,) 1: from below, -1: from above, 0: either */
    const int *terminal;    /* (count,) the run ends at this occurrence of the event, counted from 1; 0: never */
    const zd_event *known;  /* (count,) what the core reads and evaluates; NULL: all are evaluated by the callback */
    int actions;
    const zd_action *action;    /* (actions,) in their order, those of several events at one instant, too */
    const zd_system *of;    /* system whose measures are read; NULL: the simulated system */
    void *data;
    /* Callbacks: value of an event function, with the arguments x that the core reads for it, and notification of an event at its instant,
     * NULL: none. Both return 0, or ZD_CALLBACK on failure. */
    int (*evaluate)(void *data, int event, double t, const double *p, const double *v, const double *x, double *value);
    int (*found)(void *data, int event, double t, const double *p, const double *v);
} zd_events;

/* ---- outputs: measures that are recorded in every sample ---- */

typedef struct zd_outputs {
    const zd_system *of;    /* system whose measures are evaluated, with the same coordinates; NULL: the simulated system */
    int count;
    const int *measure;     /* (count,) indices of measures; a sample holds their components in this order */
} zd_outputs;

/* ---- inputs: numbers that the caller sets between steps ---- */

typedef struct zd_input_slot {
    int input;                  /* index of the input that is written there */
    int is_speed;               /* false: place[0] is the input. True: the speed is place[0] + place[1] (t - place[2]); it follows the
                                 * input linearly, see zd_inputs.ramp, or jumps to it */
    double *place;              /* in the data of the system, which belongs to this run */
} zd_input_slot;

typedef struct zd_inputs {
    int count;
    double *value;              /* (count,): read at the start of each advance, set by events; the places hold the initial ones already */
    const double *lower, *upper;    /* (count,): limits */
    const char *const *name;    /* (count,): for messages on speeds; NULL: their indices are given there */
    int jumps;                  /* true: speeds jump to their inputs, by an impulse, see zd_run_jump() */
    double ramp;                /* s, adaptive steps: time over which a speed follows its input; fixed steps: it is one step */
    int places;
    const zd_input_slot *place;    /* (places,) */
    int derivations;            /* functions that recompute what the system derives from its data */
    void (*const *derive)(double *data);    /* (derivations,) */
    double *const *data;        /* (derivations,) */
} zd_inputs;

/* ---- settings of a run ---- */

enum { ZD_CORRECTIONS_MAX = 8, ZD_ROW_VALUES = 16 };

/* Parameters of a formulation, an integrator or a correction, in the order of its card. */
typedef struct zd_parameter_values {
    int given;                      /* 0: the correction is off; a formulation or an integrator has its default parameters */
    double value[ZD_ROW_VALUES];    /* values of all parameters, vectors entry after entry */
} zd_parameter_values;

/* Action at a bifurcation, where constraints that are independent elsewhere become dependent, so that several motions satisfy them: end
 * the run, or continue along the present branch; from rest, along the branch of least acceleration. */
enum zd_on_singular { ZD_STOP, ZD_CONTINUE };

/* Sizes of steps: given, or by the error estimate of the integrator. */
enum zd_steps { ZD_FIXED_STEPS, ZD_ADAPTIVE_STEPS };

typedef struct zd_settings {
    int formulation, integrator;    /* indices in their tables */
    double t0, t1;                  /* s */
    enum zd_steps steps;
    double step;                    /* fixed steps: size, s; the last one is shortened to end at t1 */
    double rtol, atol;              /* adaptive steps: tolerances of the local error of the state */
    double first_step, max_step;    /* adaptive steps, s; 0: not given, unbounded */
    double max_move;                /* adaptive steps: largest change of an entry of p in one step, in its unit; 0: unbounded */
    int64_t max_steps;              /* adaptive steps: the run fails after this many; 0: unbounded */
    int64_t save_every;             /* steps per sample */
    const double *t_eval;           /* (t_evals,) s: times of samples, instead of save_every; NULL: not given */
    int64_t t_evals;
    const zd_events *events;        /* NULL: none */
    const zd_outputs *outputs;      /* NULL: none */
    const zd_inputs *inputs;        /* NULL: none */
    zd_parameter_values of_formulation, of_integrator;
    zd_parameter_values correction[ZD_CORRECTIONS_MAX];        /* parameters of each correction, in the order of their table */
    enum zd_on_singular on_singular;
    int closed_form;                     /* true: the closed-form path is taken if the system provides applicable closed-form functions */
    enum zd_unit vector;            /* widest vector unit that these may use */
    int given_jacobian;             /* true if C and Phi_t are hand-written: they are compared with differences of Phi at intervals */
    int is_open;                    /* true: the run has no end, and returns to the start of a step that fails; t1 only serves the
                                     * checks of the start, as the time scale of the motion */
} zd_settings;

/* Default parameters of a card. */
zd_parameter_values zd_initial(const zd_card *card);
/* Pointer to the value of the parameter of that name; NULL: the card has no such parameter. */
double *zd_value_named(zd_parameter_values *given, const zd_card *card, const char *name);
/* Checks the parameters by the rules of their card and of the entry itself; the first violation is described in `message`. */
int zd_check_parameter_values(enum zd_table table, int row, const zd_parameter_values *given, char *message, int message_size);

enum zd_unit zd_processor_unit(void);       /* widest vector unit of this processor */
int zd_processor_has(enum zd_unit unit);

/* Sines and reductions of large arguments, passed to libraries compiled with ZD_LARGE_SINES_OF_CORE: see zerodrift/sines.h. */
void zd_sines_of_large(int n, const double *angle, double *s, double *c);
void zd_reductions_of_large(int n, const double *angle, double *r, double *tail, uint64_t *quadrant);

#endif
