/* The paper's four-bar from (start, rates), with all corrections after every step; returns alpha_1 at the end. */
double four_bar_floor(const double *start, const double *rates, double h, int steps, double tolerance);
