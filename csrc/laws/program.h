/* Programs: straight lines of instructions. Each computes a value from earlier ones of a frame, with the operations, and hence the bits, of
 * the same expressions in C without contraction.
 *
 * Plain declarations only: CFFI parses this text.
 */
#pragma once

#include <stdint.h>

#include "../include/zerodrift/closed_form.h"

/* Operands a, b, c are places in the frame, except where noted. */
enum zd_code {
    ZD_CODE_PLUS, ZD_CODE_MINUS, ZD_CODE_TIMES, ZD_CODE_OVER, ZD_CODE_NEGATIVE,
    ZD_CODE_LESS, ZD_CODE_LESS_EQUAL, ZD_CODE_GREATER, ZD_CODE_GREATER_EQUAL, ZD_CODE_EQUAL, ZD_CODE_UNEQUAL,     /* 1 if true, else 0 */
    ZD_CODE_AND, ZD_CODE_OR, ZD_CODE_NOT,
    ZD_CODE_CHOOSE,         /* b if a is not 0, otherwise c */
    ZD_CODE_SPLINE,         /* a zd_spline, whose address is a, at b: derivative of order c */
    ZD_CODE_POWER, ZD_CODE_ROOT, ZD_CODE_SIN, ZD_CODE_COS, ZD_CODE_TAN, ZD_CODE_ASIN, ZD_CODE_ACOS, ZD_CODE_ATAN, ZD_CODE_ATAN2,
    ZD_CODE_SINH, ZD_CODE_COSH, ZD_CODE_TANH, ZD_CODE_ASINH, ZD_CODE_ACOSH, ZD_CODE_ATANH, ZD_CODE_EXP, ZD_CODE_LOG, ZD_CODE_ABS,
    ZD_CODE_FLOOR, ZD_CODE_CEILING, ZD_CODE_ERF, ZD_CODE_ERFC, ZD_CODE_EXPM1, ZD_CODE_HYPOT, ZD_CODE_LOG1P, ZD_CODE_LOG2,
    ZD_CODE_LOG10, ZD_CODE_GAMMA, ZD_CODE_LOGGAMMA, ZD_CODE_FMOD,
    ZD_CODE_TIMES_PLUS,     /* a b + c, rounded twice */
    ZD_CODE_TIMES_MINUS,    /* a b - c */
    ZD_CODE_MINUS_TIMES,    /* c - a b */
    ZD_CODE_SINES,          /* sines of this and the next instructions' a, b (a number) in all; then the cosines */
    ZD_CODE_END,            /* End of the program */
    ZD_PROGRAM_CODES
};

enum { ZD_SINES_AT_ONCE = 16 };     /* angles of an instruction */

typedef struct zd_instruction {
    uint16_t code;          /* enum zd_code */
    uint16_t a, b, c;
} zd_instruction;

/* Expressions of numbers of their own, t, quantities x and their rates: a frame has these in this order, then values. */
typedef struct zd_expressions {
    const zd_instruction *first;
    int numbers, terms, rates, results;
    int frame;                  /* values, at most ZD_FRAME */
    const uint16_t *result;     /* (results,) places in the frame */
} zd_expressions;

enum { ZD_FRAME = 8192 };
/* Memory of a frame, on the stack */
#if defined(__GNUC__)
#define ZD_VALUES(type, name, frame) type *const name = __builtin_alloca_with_align((size_t)(frame) * sizeof(type), 8 * _Alignof(type))
#else
#define ZD_VALUES(type, name, frame) type name[ZD_FRAME]
#endif

/* out (results,) <- values of expressions of numbers (numbers,) at t, x (terms,) and xdot (rates,). */
void zd_expressions_evaluate(const zd_expressions *self, const double *numbers, double t, const double *x, const double *xdot, double *out);
/* The same at so many states: t (states,), x (states, terms), and so on. */
void zd_expressions_evaluate_all(const zd_expressions *self, const double *numbers, int64_t states, const double *t, const double *x,
                                 const double *xdot, double *out);
/* True if one of the expressions may have a table whose ends are an error; if all values are defined at a state whose quantities may be off
 * by atol + rtol |x|: a table beyond such an end has none. */
int zd_expressions_have_ends(const zd_expressions *self, const double *numbers);
int zd_expressions_are_defined(const zd_expressions *self, const double *numbers, double rtol, double atol, double t, const double *x,
                               const double *xdot);
/* True if all tables are read at t, within their ends. */
int zd_expressions_are_within(const zd_expressions *self, const double *numbers, double t);
/* Runs instructions without units; values go to `to` and the places after it, within the frame `value`. */
void zd_program_run(const zd_instruction *next, double *value, double *to);
/* The value of an operation on values. */
double zd_operation(enum zd_code code, double a, double b, double c);
