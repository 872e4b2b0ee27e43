/* The explicit Runge-Kutta method of order eight by Dormand and Prince, in the twelve stages of DOP853. Coefficients: E. Hairer,
 * S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, 1993, section II.5.
 */
#include "interpolation.h"

enum { STAGES = 12, MORE = 2, ALL = STAGES + 1 + MORE };    /* for values between: f at the end, and two stages more */

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

/* Coefficients of the additional stages and of the polynomial for dense output. With the three stages of the book it has order seven. These
 * two satisfy all conditions of order six and the quadrature of order seven; the other conditions of order seven, which two stages cannot all
 * satisfy, have a residual of at most 8e-8 (root of the sum of squares over the trees). Those of order eight have a residual of 1.3e-5, and
 * of 3.8e-5 with the stages of the book. Errors are therefore smaller than those for h L > 0.003; in shorter steps the term in h^7 is far
 * below rounding.
 */
static const double more_a[MORE * ALL] = {
    [0 * ALL + 0] = 0.06425056847867465, [0 * ALL + 6] = 0.42843873933159243, [0 * ALL + 7] = -0.39968173097686277,
    [0 * ALL + 8] = -0.19483893952364506, [0 * ALL + 9] = 0.23975446091153224, [0 * ALL + 10] = 0.01340615366453874,
    [0 * ALL + 11] = 0.012593748114148411, [0 * ALL + 12] = -0.013922999999978668,
    [1 * ALL + 0] = 0.017701375142361846, [1 * ALL + 6] = -1.0708765815738386, [1 * ALL + 7] = 1.0520730763103665,
    [1 * ALL + 8] = 0.22701732697861635, [1 * ALL + 10] = 0.030453741704275804, [1 * ALL + 11] = -0.05772456606512873,
    [1 * ALL + 12] = 0.0526706553598941, [1 * ALL + 13] = 0.5286849721434527,
};
static const double more_c[MORE] = {0.15, 0.78};
static const double d[4 * ALL] = {
    [0 * ALL + 0] = -6.198999968790632, [0 * ALL + 5] = 96.63988384915052, [0 * ALL + 6] = 17.496812413206328,
    [0 * ALL + 7] = -122.89215354952202, [0 * ALL + 8] = 6.238909326159946, [0 * ALL + 9] = -6.950532102156817,
    [0 * ALL + 10] = 3.22704598280267, [0 * ALL + 11] = 1.102184614560485, [0 * ALL + 12] = -0.690665647971489,
    [0 * ALL + 13] = 17.819869752353615, [0 * ALL + 14] = -5.79235466979262,
    [1 * ALL + 0] = 7.165843611240995, [1 * ALL + 5] = 168.9107062557312, [1 * ALL + 6] = 154.09473068505562,
    [1 * ALL + 7] = -282.86788278745536, [1 * ALL + 8] = -27.875679101124707, [1 * ALL + 9] = 13.515778384631407,
    [1 * ALL + 10] = -34.206908553480226, [1 * ALL + 11] = -10.485343117487835, [1 * ALL + 12] = 17.19591848742782,
    [1 * ALL + 13] = -46.21095621392872, [1 * ALL + 14] = 40.76379234938601,
    [2 * ALL + 0] = 11.474755842468953, [2 * ALL + 5] = -873.5047705227267, [2 * ALL + 6] = -293.8791477382396,
    [2 * ALL + 7] = 1166.503175625236, [2 * ALL + 8] = -29.037952072568483, [2 * ALL + 9] = 36.99919920872514,
    [2 * ALL + 10] = -2.285713411743951, [2 * ALL + 11] = -0.6473171256504077, [2 * ALL + 12] = -1.0648204943680066,
    [2 * ALL + 13] = -27.702328586675563, [2 * ALL + 14] = 13.144919275543131,
    [3 * ALL + 0] = -14.264960762568114, [3 * ALL + 5] = 264.6148849481709, [3 * ALL + 6] = -162.18965659930092,
    [3 * ALL + 7] = -178.52876645125417, [3 * ALL + 8] = 116.762663521382, [3 * ALL + 9] = -67.9580914686296,
    [3 * ALL + 10] = 113.944023686743, [3 * ALL + 11] = 33.6787938856056, [3 * ALL + 12] = -48.33709663675316,
    [3 * ALL + 13] = 104.73205609639349, [3 * ALL + 14] = -162.45385021977293,
};

static const zd_tableau tableau = {
    .stages = STAGES, .a = a, .b = b, .c = c, .e = e5, .e3 = e3, .more = MORE, .coefficients = 7, .more_a = more_a, .more_c = more_c, .d = d,
};

ZD_RUNGE_KUTTA_STEP
ZD_RUNGE_KUTTA_ERROR
ZD_RUNGE_KUTTA_INTERPOLATION

const zd_integrator zd_dop853 = {
    .card = {
        .name = "dop853",
        .summary = "The explicit Runge-Kutta method of Dormand and Prince with twelve stages.",
        .equations = "Hairer et al., section II.5",
        .order = 8, .error_order = 7, .stability = 5.97,
        .description = "Order eight with error estimates of orders five and three, blended, for adaptive steps. Twelve evaluations for each "
                       "step, which are efficient for errors below 1e-6. Its dense output takes two more evaluations and has order seven, "
                       "up to rounding.",
        .reference = "E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, Springer, "
                     "1993, section II.5",
    },
    .decay = 6.39,
    ZD_RUNGE_KUTTA, .error = error, ZD_INTERPOLATED,
};
