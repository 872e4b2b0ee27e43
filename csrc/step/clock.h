/* The wall clock. */
#ifndef ZD_CLOCK_H
#define ZD_CLOCK_H

double zd_seconds_now(void);

#endif
