/* The explicit Runge-Kutta method of order eight by Dormand and Prince, in the twelve stages of DOP853. Coefficients: E. Hairer,
 * S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, 1993, section II.5.
 */
#include "runge_kutta.h"

enum { STAGES = 12, MORE = 3, ALL = STAGES + 1 + MORE };    /* for values between: f at the end, and three stages more */

static const double a[STAGES * STAGES] = {
    [1 * STAGES + 0] = 0.05260015195876773,
    [2 * STAGES + 0] = 0.0197250569845379, [2 * STAGES + 1] = 0.0591751709536137,
    [3 * STAGES + 0] = 0.02958758547680685, [3 * STAGES + 2] = 0.08876275643042054,
    [4 * STAGES + 0] = 0.2413651341592667, [4 * STAGES + 2] = -0.8845494793282861, [4 * STAGES + 3] = 0.924834003261792,
    [5 * STAGES + 0] = 0.037037037037037035, [5 * STAGES + 3] = 0.17082860872947386, [5 * STAGES + 4] = 0.12546768756682242,
    [6 * STAGES + 0] = 0.037109375, [6 * STAGES + 3] = 0.17025221101954405, [6 * STAGES + 4] = 0.06021653898045596,
    [6 * STAGES + 5] = -0.017578125,
    [7 * STAGES + 0] = 0.03709200011850479, [7 * STAGES + 3] = 0.17038392571223998, [7 * STAGES + 4] = 0.10726203044637328,
    [7 * STAGES + 5] = -0.015319437748624402, [7 * STAGES + 6] = 0.008273789163814023,
    [8 * STAGES + 0] = 0.6241109587160757, [8 * STAGES + 3] = -3.3608926294469414, [8 * STAGES + 4] = -0.868219346841726,
    [8 * STAGES + 5] = 27.59209969944671, [8 * STAGES + 6] = 20.154067550477894, [8 * STAGES + 7] = -43.48988418106996,
    [9 * STAGES + 0] = 0.47766253643826434, [9 * STAGES + 3] = -2.4881146199716677, [9 * STAGES + 4] = -0.590290826836843,
    [9 * STAGES + 5] = 21.230051448181193, [9 * STAGES + 6] = 15.279233632882423, [9 * STAGES + 7] = -33.28821096898486,
    [9 * STAGES + 8] = -0.020331201708508627,
    [10 * STAGES + 0] = -0.9371424300859873, [10 * STAGES + 3] = 5.186372428844064, [10 * STAGES + 4] = 1.0914373489967295,
    [10 * STAGES + 5] = -8.149787010746927, [10 * STAGES + 6] = -18.52006565999696, [10 * STAGES + 7] = 22.739487099350505,
    [10 * STAGES + 8] = 2.4936055526796523, [10 * STAGES + 9] = -3.0467644718982196,
    [11 * STAGES + 0] = 2.273310147516538, [11 * STAGES + 3] = -10.53449546673725, [11 * STAGES + 4] = -2.0008720582248625,
    [11 * STAGES + 5] = -17.9589318631188, [11 * STAGES + 6] = 27.94888452941996, [11 * STAGES + 7] = -2.8589982771350235,
    [11 * STAGES + 8] = -8.87285693353063, [11 * STAGES + 9] = 12.360567175794303, [11 * STAGES + 10] = 0.6433927460157636,
};
static const double b[STAGES] = {
    0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, 0.3111643669578199,
    -0.1521609496625161, 0.20136540080403034, 0.04471061572777259,
};
static const double c[STAGES] = {
    0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726, 0.3333333333333333, 0.25,
    0.3076923076923077, 0.6512820512820513, 0.6, 0.8571428571428571, 1.0,
};

static const double e5[STAGES + 1] = {
    0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864, -0.35032884874997366,
    0.3341791187130175, 0.08192320648511571, -0.022355307863886294, 0,
};
static const double e3[STAGES + 1] = {
    -0.18980075407240762, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, -0.4226823213237919,
    -0.1521609496625161, 0.20136540080403034, 0.02265179219836082, 0,
};

/* Of the stages for values between, and of the polynomial */
static const double more_a[MORE * ALL] = {
    [0 * ALL + 0] = 0.056167502283047954, [0 * ALL + 6] = 0.25350021021662483, [0 * ALL + 7] = -0.2462390374708025,
    [0 * ALL + 8] = -0.12419142326381637, [0 * ALL + 9] = 0.15329179827876568, [0 * ALL + 10] = 0.00820105229563469,
    [0 * ALL + 11] = 0.007567897660545699, [0 * ALL + 12] = -0.008298,
    [1 * ALL + 0] = 0.03183464816350214, [1 * ALL + 5] = 0.028300909672366776, [1 * ALL + 6] = 0.053541988307438566,
    [1 * ALL + 7] = -0.05492374857139099, [1 * ALL + 10] = -0.00010834732869724932, [1 * ALL + 11] = 0.0003825710908356584,
    [1 * ALL + 12] = -0.00034046500868740456, [1 * ALL + 13] = 0.1413124436746325,
    [2 * ALL + 0] = -0.42889630158379194, [2 * ALL + 5] = -4.697621415361164, [2 * ALL + 6] = 7.683421196062599,
    [2 * ALL + 7] = 4.06898981839711, [2 * ALL + 8] = 0.3567271874552811, [2 * ALL + 12] = -0.0013990241651590145,
    [2 * ALL + 13] = 2.9475147891527724, [2 * ALL + 14] = -9.15095847217987,
};
static const double more_c[MORE] = {0.1, 0.2, 0.7777777777777778};
static const double d[4 * ALL] = {
    [0 * ALL + 0] = -8.428938276109013, [0 * ALL + 5] = 0.5667149535193777, [0 * ALL + 6] = -3.0689499459498917,
    [0 * ALL + 7] = 2.38466765651207, [0 * ALL + 8] = 2.117034582445028, [0 * ALL + 9] = -0.871391583777973,
    [0 * ALL + 10] = 2.2404374302607883, [0 * ALL + 11] = 0.6315787787694688, [0 * ALL + 12] = -0.08899033645133331,
    [0 * ALL + 13] = 18.148505520854727, [0 * ALL + 14] = -9.194632392478356, [0 * ALL + 15] = -4.436036387594894,
    [1 * ALL + 0] = 10.427508642579134, [1 * ALL + 5] = 242.28349177525817, [1 * ALL + 6] = 165.20045171727028,
    [1 * ALL + 7] = -374.5467547226902, [1 * ALL + 8] = -22.113666853125306, [1 * ALL + 9] = 7.733432668472264,
    [1 * ALL + 10] = -30.674084731089398, [1 * ALL + 11] = -9.332130526430229, [1 * ALL + 12] = 15.697238121770845,
    [1 * ALL + 13] = -31.139403219565178, [1 * ALL + 14] = -9.35292435884448, [1 * ALL + 15] = 35.81684148639408,
    [2 * ALL + 0] = 19.985053242002433, [2 * ALL + 5] = -387.0373087493518, [2 * ALL + 6] = -189.17813819516758,
    [2 * ALL + 7] = 527.8081592054236, [2 * ALL + 8] = -11.57390253995963, [2 * ALL + 9] = 6.8812326946963,
    [2 * ALL + 10] = -1.0006050966910838, [2 * ALL + 11] = 0.7777137798053443, [2 * ALL + 12] = -2.778205752353508,
    [2 * ALL + 13] = -60.19669523126412, [2 * ALL + 14] = 84.32040550667716, [2 * ALL + 15] = 11.99229113618279,
    [3 * ALL + 0] = -25.69393346270375, [3 * ALL + 5] = -154.18974869023643, [3 * ALL + 6] = -231.5293791760455,
    [3 * ALL + 7] = 357.6391179106141, [3 * ALL + 8] = 93.40532418362432, [3 * ALL + 9] = -37.45832313645163,
    [3 * ALL + 10] = 104.0996495089623, [3 * ALL + 11] = 29.8402934266605, [3 * ALL + 12] = -43.53345659001114,
    [3 * ALL + 13] = 96.32455395918828, [3 * ALL + 14] = -39.17726167561544, [3 * ALL + 15] = -149.72683625798564,
};

static const zd_tableau tableau = {
    .stages = STAGES, .a = a, .b = b, .c = c, .e = e5, .e3 = e3, .more = MORE, .more_a = more_a, .more_c = more_c, .d = d,
};

ZD_RUNGE_KUTTA_STEP
ZD_RUNGE_KUTTA_ERROR

/* to <- h sum_j weight_j k_j, over all stages there are */
ZD_INLINE void add_up(const int size, const double *weight, double h, const double *restrict k, double *restrict to)
{
    for (int i = 0; i < size; i++) {
        double sum = 0;
        ZD_UNROLL
        for (int j = 0; j < ALL; j++)
            if (weight[j] != 0) sum += weight[j] * k[j * size + i];
        to[i] = h * sum;
    }
}

/* The polynomial between the ends of the step just made, of order seven: its coefficients are seven vectors. */
ZD_INLINE int spread_sized(const int size, zd_runge_kutta *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1)
{
    const int positions = rate->direct ? rate->system->nq : 0;
    double *k = self->k, *F = self->polynomial, *f1 = k + STAGES * size;
    int status = rate->evaluate(rate->context, t + h, y1, f1);
    ZD_UNROLL
    for (int i = 0; i < MORE; i++) {
        if (status) return status;
        zd_combine(positions, size, STAGES + 1 + i, more_a + i * ALL, h, k, y0, self->stage);
        status = zd_rate_of_stage(rate, t + more_c[i] * h, self->stage, k + (STAGES + 1 + i) * size);
    }
    for (int i = 0; i < size; i++) {
        const double change = y1[i] - y0[i];
        F[i] = change;
        F[size + i] = h * k[i] - change;
        F[2 * size + i] = 2 * change - h * (f1[i] + k[i]);
    }
    ZD_UNROLL
    for (int i = 0; i < 4; i++) add_up(size, d + i * ALL, h, k, F + (3 + i) * size);
    return status;
}

/* Of three and four coordinates with as many velocities, whose sums are written out; and of any */
static int spread(void *memory, const zd_rate *rate, double t, double h, const double *y0, const double *y1)
{
    zd_runge_kutta *self = memory;
    return self->size == 6   ? spread_sized(6, self, rate, t, h, y0, y1)
         : self->size == 8   ? spread_sized(8, self, rate, t, h, y0, y1)
                             : spread_sized(self->size, self, rate, t, h, y0, y1);
}

static void between(const void *memory, double x, const double *y0, double *y)
{
    const zd_runge_kutta *self = memory;
    const int n = self->size;
    const double *F = self->polynomial, z = 1 - x;
    for (int i = 0; i < n; i++) {
        const double inner = F[3 * n + i] + x * (F[4 * n + i] + z * (F[5 * n + i] + x * F[6 * n + i]));
        y[i] = y0[i] + x * (F[i] + z * (F[n + i] + x * (F[2 * n + i] + z * inner)));
    }
}

const zd_integrator zd_dop853 = {
    .card = {
        .name = "dop853",
        .summary = "The explicit Runge-Kutta method of Dormand and Prince with twelve stages.",
        .equations = "Hairer et al., section II.5",
        .order = 8, .error_order = 7, .stability = 5.97,
        .description = "Order eight with error estimates of orders five and three, blended, by which it can choose its steps. "
                       "Twelve evaluations for each step, which are soon made up for where the error is to be below 1e-6.",
        .reference = "E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, Springer, "
                     "1993, section II.5",
    },
    .decay = 6.39,
    ZD_RUNGE_KUTTA, .error = error, .spread = spread, .between = between,
};
