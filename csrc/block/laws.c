/* A law is a straight-line program: each instruction computes one value from earlier ones, with the operations, and hence the bits, of
 * the compiled function of the same expression. */
#include "made.h"

/* ---- checks ---- */

/* Number of operands that are values; ZD_CODE_NUMBER to ZD_CODE_RESULT and ZD_CODE_SPLINE are treated individually. */
static int operands_of(enum zd_code code)
{
    switch (code) {
    case ZD_CODE_CHOOSE: return 3;
    case ZD_CODE_PLUS: case ZD_CODE_MINUS: case ZD_CODE_TIMES: case ZD_CODE_OVER: case ZD_CODE_LESS: case ZD_CODE_LESS_EQUAL:
    case ZD_CODE_GREATER: case ZD_CODE_GREATER_EQUAL: case ZD_CODE_EQUAL: case ZD_CODE_UNEQUAL: case ZD_CODE_AND: case ZD_CODE_OR:
    case ZD_CODE_POWER: case ZD_CODE_ATAN2: case ZD_CODE_HYPOT: return 2;
    default: return 1;
    }
}

/* `number` instructions precede it in its law, which has so many marker quantities and results. */
static int instruction_is_right(const zd_block_layout *layout, const double *word, int number, double terms, double results)
{
    if (!zd_block_is_integer(word[0], 0, ZD_CODES)) return 0;
    const enum zd_code code = (enum zd_code)(int)word[0];
    switch (code) {
    case ZD_CODE_NUMBER: case ZD_CODE_TIME: return 1;
    case ZD_CODE_X: case ZD_CODE_XDOT: return zd_block_is_integer(word[1], 0, terms);
    case ZD_CODE_RESULT: return zd_block_is_integer(word[1], 0, results) && zd_block_is_integer(word[2], 0, number);
    case ZD_CODE_INPUT: return zd_block_is_integer(word[1], 0, zd_block_count(layout, ZD_BLOCK_INPUTS)) && zd_block_is_integer(word[2], 0, 3);
    case ZD_CODE_SPLINE:
        return zd_block_is_integer(word[1], 0, zd_block_count(layout, ZD_BLOCK_SPLINES)) && zd_block_is_integer(word[2], 0, number) &&
               zd_block_is_integer(word[3], 0, 3);
    default: break;
    }
    for (int i = 1; i <= operands_of(code); i++)
        if (!zd_block_is_integer(word[i], 0, number)) return 0;
    return 1;
}

/* Every result must be written. */
static int has_results(const zd_block_layout *layout, const double *law)
{
    for (int result = 0; result < (int)law[3]; result++) {
        int is_written = 0;
        for (int i = 0; i < (int)law[1]; i++) {
            const double *word = zd_block_entry(layout, ZD_BLOCK_INSTRUCTIONS, (int)law[0] + i);
            is_written |= zd_block_is(word[0], ZD_CODE_RESULT) && word[1] == result;
        }
        if (!is_written) return 0;
    }
    return 1;
}

static int law_is_right(const zd_block_layout *layout, int law, zd_complaint to)
{
    const double *word = zd_block_entry(layout, ZD_BLOCK_LAWS, law), instructions = zd_block_count(layout, ZD_BLOCK_INSTRUCTIONS);
    if (!zd_block_is_integer(word[0], 0, instructions) || !zd_block_is_integer(word[1], 1, instructions - word[0] + 1) ||
        !zd_block_is_integer(word[2], 0, 0x1p20) || !zd_block_is_integer(word[3], 1, 0x1p20))
        return zd_complain(to, "law %d: its instructions must exist, and its counts be whole numbers", law);
    for (int i = 0; i < (int)word[1]; i++)
        if (!instruction_is_right(layout, zd_block_entry(layout, ZD_BLOCK_INSTRUCTIONS, (int)word[0] + i), i, word[2], word[3]))
            return zd_complain(to, "law %d: the code and the operands of instruction %d must exist", law, i);
    return has_results(layout, word) || zd_complain(to, "law %d: every result must be written", law);
}

static int spline_is_right(const zd_block_layout *layout, int spline, zd_complaint to)
{
    const double *word = zd_block_entry(layout, ZD_BLOCK_SPLINES, spline), knots = zd_block_count(layout, ZD_BLOCK_KNOTS);
    if (!zd_block_is_integer(word[0], 0, knots) || !zd_block_is_integer(word[1], 2, knots - word[0] + 1))
        return zd_complain(to, "spline %d: it must have at least 2 knots, which must exist", spline);
    const double *knot = zd_block_entry(layout, ZD_BLOCK_KNOTS, (int)word[0]);
    for (int i = 1; i < (int)word[1]; i++)
        if (!(knot[5 * i] > knot[5 * (i - 1)])) return zd_complain(to, "spline %d: abscissas of knots must increase", spline);
    return 1;
}

int zd_block_laws_check(const zd_block_layout *layout, zd_complaint to)
{
    int longest = 0;
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_SPLINES); i++)
        if (!spline_is_right(layout, i, to)) return -1;
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_LAWS); i++) {
        if (!law_is_right(layout, i, to)) return -1;
        const int instructions = (int)zd_block_entry(layout, ZD_BLOCK_LAWS, i)[1];
        if (instructions > longest) longest = instructions;
    }
    return longest;
}

int zd_block_law_suits(const zd_block_layout *layout, int law, int terms, int results)
{
    if (!zd_is_in(law, zd_block_count(layout, ZD_BLOCK_LAWS))) return 0;
    const double *word = zd_block_entry(layout, ZD_BLOCK_LAWS, law);
    return word[2] == terms && word[3] == results;
}

/* ---- evaluation ---- */

/* value <- derivative of order 0, 1 or 2 of a spline at x. Returns 0 beyond its ends, up to rounding. */
static int spline_value(const zd_block_layout *layout, int spline, double x, int order, double *value)
{
    static const double BEYOND = 1e-9;      /* rounding beyond the ends, part of the length, that is accepted as in laws/table.py */
    const double *word = zd_block_entry(layout, ZD_BLOCK_SPLINES, spline);
    const double *knot = zd_block_entry(layout, ZD_BLOCK_KNOTS, (int)word[0]);
    int low = 0, high = (int)word[1] - 1;
    const double allowed = BEYOND * (knot[5 * high] - knot[0]);
    if (!(x >= knot[0] - allowed && x <= knot[5 * high] + allowed)) return 0;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (knot[5 * middle] <= x) low = middle;
        else high = middle;
    }
    const double s = x - knot[5 * low], *coefficient = knot + 5 * low + 1;
    double r = 0, first = 0, second = 0;
    for (int i = 0; i < 4; i++) {
        second = second * s + 2 * first;
        first = first * s + r;
        r = r * s + coefficient[i];
    }
    *value = order == 0 ? r : order == 1 ? first : second;
    return 1;
}

int zd_block_law(void *owner, int law, double t, const double *x, const double *xdot, double *out)
{
    const zd_block_laws *self = owner;
    const double *of = zd_block_entry(self->layout, ZD_BLOCK_LAWS, law);
    const double *word = zd_block_entry(self->layout, ZD_BLOCK_INSTRUCTIONS, (int)of[0]);
    double *value = self->value;
    for (int i = 0; i < (int)of[1]; i++, word += 4) {
        const enum zd_code code = (enum zd_code)(int)word[0];
        switch (code) {
        case ZD_CODE_NUMBER: value[i] = word[1]; break;
        case ZD_CODE_TIME: value[i] = t; break;
        case ZD_CODE_X: value[i] = x[(int)word[1]]; break;
        case ZD_CODE_XDOT: value[i] = xdot[(int)word[1]]; break;
        case ZD_CODE_RESULT: out[(int)word[1]] = value[i] = value[(int)word[2]]; break;
        case ZD_CODE_INPUT: value[i] = self->speed[3 * (int)word[1] + (int)word[2]]; break;
        case ZD_CODE_SPLINE:
            if (!spline_value(self->layout, (int)word[1], value[(int)word[2]], (int)word[3], value + i)) return ZD_CALLBACK;
            break;
        default: {
            const int operands = operands_of(code);
            value[i] = zd_operation(code, value[(int)word[1]], operands > 1 ? value[(int)word[2]] : 0,
                                       operands > 2 ? value[(int)word[3]] : 0);
        }
        }
    }
    return ZD_DONE;
}
