/* A mechanism as one block of data, from which a system is made without Python.
 *
 * A block is a sequence of words of eight bytes, little-endian. The first word is the text "zdblock" and a zero byte; every other word
 * outside the section of texts is a double, whole numbers included, and finite. Words in order:
 *
 *     0       "zdblock\0"
 *     1       version of this description: ZD_BLOCK_VERSION
 *     2       number of words of the block, header included
 *     3       dimension of the mechanism: 2 or 3
 *     4 ...   number of entries of each section, in the order of enum zd_block_section
 *
 * and the sections follow each other in the same order, without gaps. An entry of a section has these words:
 *
 *     gravity         one component each: 2 or 3 entries; and the length that moments are divided by in the least reactions
 *     bodies ...      the members of zd_plane_body, zd_plane_joint, zd_plane_quantity of mechanisms/plane/tables.h, or of zd_space_body,
 *                     zd_space_joint, zd_space_quantity of mechanisms/space/tables.h, in their order, arrays entry after entry
 *     terms ...       those of zd_quantity_term, zd_relation, zd_generalized_force, zd_output_spec and zd_element_group of
 *                     mechanisms/common/elements.h
 *     laws            user functions, zd_expressions of laws/program.h: first instruction and number of instructions, number of marker
 *                     quantities x, first result and number of results, first number and number of numbers. There are 1 result for a
 *                     generalized force; for a relation with k terms the k + 3 that zd_law describes
 *     instructions    code, and three operands: enum zd_code of laws/program.h
 *     results         place in the frame of a law
 *     numbers         number of a law; that of a spline, which an instruction reads as its first operand, is its index
 *     splines         first knot, number of knots: at least 2, abscissas increasing
 *     knots           abscissa, and coefficients of powers 3, 2, 1, 0 of the distance from it, valid to the next knot
 *     start           p, then v: one entry each; none if the start is not given
 *     outputs         index of a measure that a run records
 *     inputs          name, unit, enum zd_block_input_kind, index of a force or law, and initial value
 *     settings        t0, step, rtol, atol, first step, maximum step, maximum move, maximum number of steps, 1 to continue at
 *                     bifurcations: one entry or none; as in zd_settings
 *     methods         table (enum zd_table), name, and ZD_ROW_VALUES values of its parameters: of the formulation, the integrator and
 *                     each correction that is on; none of a table: its default
 *     names           of bodies, joints and relations, in this order; none, or one of each
 *     parameters      name, unit, value, smallest and largest value
 *     effects         word of the block that depends on parameters, first and number of its products, whose sum it is
 *     products        a factor, and three pairs of a parameter and its exponent; exponents 0 to 8
 *     events          of a run: enum zd_source of a quantity, p, v or a measure, its index and component, the value that it reaches, 1 from
 *                     below, -1 from above, or 0, and the occurrence that ends the run, counted from 1; 0: none
 *     actions         event, index of an input that it sets, or that of zd_action for a group, and the value
 *     texts           UTF-8, each ended by a zero byte, the last word filled with zero bytes; an entry is a word
 *
 * A name or unit is the offset of its text, in bytes. Kinds are numbered as in the tables of the core of this version; body 0 is the ground.
 * A block with a wrong count, an index out of range, or a number that is not finite is refused with a sentence.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include <stddef.h>

#include "../laws/program.h"
#include "../zerodrift.h"

enum { ZD_BLOCK_VERSION = 7 };

enum zd_block_section {
    ZD_BLOCK_GRAVITY, ZD_BLOCK_BODIES, ZD_BLOCK_JOINTS, ZD_BLOCK_QUANTITIES,
    ZD_BLOCK_TERMS, ZD_BLOCK_RELATIONS, ZD_BLOCK_FORCES, ZD_BLOCK_MEASURES, ZD_BLOCK_GROUPS,
    ZD_BLOCK_LAWS, ZD_BLOCK_INSTRUCTIONS, ZD_BLOCK_RESULTS, ZD_BLOCK_NUMBERS, ZD_BLOCK_SPLINES, ZD_BLOCK_KNOTS,
    ZD_BLOCK_START, ZD_BLOCK_OUTPUTS, ZD_BLOCK_INPUTS, ZD_BLOCK_SETTINGS, ZD_BLOCK_METHODS, ZD_BLOCK_NAMES,
    ZD_BLOCK_PARAMETERS, ZD_BLOCK_EFFECTS, ZD_BLOCK_PRODUCTS, ZD_BLOCK_EVENTS, ZD_BLOCK_ACTIONS, ZD_BLOCK_TEXTS,
    ZD_BLOCK_SECTIONS
};

/* Numbers that are set between steps. */
enum zd_block_input_kind {
    ZD_INPUT_FORCE,         /* value of a force of kind ZD_FORCE_CONSTANT */
    ZD_INPUT_SPEED          /* a speed, linear in time within a step: the first three numbers of a law, see zd_input_slot */
};

typedef struct zd_block zd_block;

/* Makes the mechanism from a copy of the block; name and unit of measures are texts of this copy. NULL on failure, with the reason in
 * `message`. A block belongs to one run: user functions write into its memory. */
zd_block *zd_block_create(const void *data, size_t size, char *message, int message_size);
void zd_block_free(zd_block *block);
const zd_system *zd_block_system(const zd_block *block);
/* Start: p (nq,), v (nv,); NULL: not given. */
const double *zd_block_start(const zd_block *block);
/* poses (bodies, size) <- those of the mass centres at p: x, y, angle in the plane; in space position and principal axes, one after another.
 * `scratch` holds system->scratch doubles. Returns the size of a pose, also where `poses` is NULL and nothing is computed. */
int zd_block_poses(const zd_block *block, const double *p, double *poses, double *scratch);
int zd_block_bodies(const zd_block *block);
/* Settings of a run, with events, inputs and outputs of the block; the caller sets t1 and samples. Returns ZD_DONE, or ZD_BAD_ARGUMENT. */
int zd_block_settings(zd_block *block, zd_settings *settings, char *message, int message_size);

/* Events of its runs; NULL: none. */
const zd_events *zd_block_events_of(const zd_block *block);

int zd_block_inputs(const zd_block *block);
const char *zd_block_input_name(const zd_block *block, int input);
const char *zd_block_input_unit(const zd_block *block, int input);
double zd_block_input(const zd_block *block, int input);
/* Sets an input from the next advance of the run on. Returns ZD_DONE, or ZD_BAD_INPUT for an input that does not exist or a value that is
 * not finite. */
int zd_block_set_input(zd_block *block, int input, double value);

int zd_block_parameters(const zd_block *block);
const char *zd_block_parameter_name(const zd_block *block, int parameter);
double zd_block_parameter(const zd_block *block, int parameter);
/* Changes the block's own copy of its words; a system of these parameters is made by zd_block_create() from zd_block_words(). Returns
 * ZD_DONE, or ZD_BAD_ARGUMENT for a value outside the parameter's range. */
int zd_block_set_parameter(zd_block *block, int parameter, double value);
const double *zd_block_words(const zd_block *block, size_t *size);

/* Joints of a mechanism that cannot close, in one sentence, for Python and for pages. Plain declarations only: CFFI parses this text. */

/* message <- sentence on the gaps of the joints: at p (nq,) if `is_smallest`, otherwise in positions near p in which their sum of squares is
 * smallest. In the plane the sentence then names the loop with the largest gap of those that cannot close alone. If each can, and in space,
 * it names the three joints with the largest gaps. Returns ZD_DONE, a status of the core, or ZD_BAD_ARGUMENT for a block without names. */
int zd_block_explain_gaps(const zd_block *block, const double *p, int is_smallest, char *message, int message_size);
/* The same near the start of a block in any coordinates; `message` is unchanged if all joints can close. */
void zd_block_explain_start(const zd_block *block, char *message, int message_size);
