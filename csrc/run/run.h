/* A run and its components. */
#ifndef ZD_RUN_H
#define ZD_RUN_H

#include "../motion/motion.h"
#include "../output/between.h"
#include "../output/events.h"
#include "../output/record.h"
#include "../safeguards/safeguards.h"
#include "../step/step_loop.h"
#include "../paths/stepper.h"

enum { ZD_MESSAGE = 500 };

typedef struct zd_outcome { /* the end of the run, once reached */
    int status;
    char message[ZD_MESSAGE];
} zd_outcome;

struct zd_run {
    zd_settings settings;
    zd_motion motion;
    zd_stepper stepper;
    zd_safeguards safeguards;
    zd_step_loop loop;
    zd_recorder recorder;
    zd_output output;       /* samples and events between steps, if requested */
    zd_watch watch;
    zd_tally tally;
    zd_outcome outcome;
};

#endif
