/* The paper's four-bar from (start, rates), positions to `tolerance` and velocities corrected after every step. */

/* RK4 at fixed steps; returns alpha_1 at the end. */
double four_bar_floor(const double *start, const double *rates, double h, int steps, double tolerance);

/* DOP853 at adaptive steps to t1, rtol = atol; t, alpha (most,): where each step ended. Returns how many there were. */
int four_bar_floor_dop853(const double *start, const double *rates, double t1, double rtol, double tolerance, int most, double *t,
                          double *alpha);
