/* Inputs: forces and speeds that are set between steps. Parameters: numbers on which words of the block depend. */
#include <math.h>

#include "made.h"

/* ---- inputs ---- */

static const double *input_of(const zd_block *block, int input) { return zd_block_entry(&block->layout, ZD_BLOCK_INPUTS, input); }

/* Planned row of a relation; NULL: there is none. */
static zd_relation *row_of(const zd_block *block, int relation)
{
    for (int i = 0; i < block->system.mh + block->system.mn; i++)
        if (block->names.owner[i].owner == ZD_OF_RELATION && block->names.owner[i].index == relation) return block->row + i;
    return NULL;
}

static int is_settable(const zd_block *block, const double *input)
{
    const int is_force = input[2] == ZD_INPUT_FORCE;
    const int count = block->layout.part[is_force ? ZD_BLOCK_FORCES : ZD_BLOCK_RELATIONS].count;
    if ((!is_force && input[2] != ZD_INPUT_SPEED) || !zd_block_is_whole(input[3], 0, count)) return 0;
    return is_force ? block->force[(int)input[3]].kind == ZD_FORCE_CONSTANT : row_of(block, (int)input[3])->law < 0;
}

int zd_block_inputs_check(const zd_block *block, zd_complaint to)
{
    const zd_block_layout *layout = &block->layout;
    for (int i = 0; i < zd_block_inputs(block); i++) {
        const double *input = input_of(block, i);
        if (!zd_block_text(layout, input[0]) || !zd_block_text(layout, input[1]))
            return zd_complain(to, "input %d: the texts of its name and unit must exist", i);
        if (!is_settable(block, input))
            return zd_complain(to, "input %d: it must set an existing force or speed without a user function", i);
    }
    return 1;
}

int zd_block_inputs(const zd_block *block) { return block->layout.part[ZD_BLOCK_INPUTS].count; }

const char *zd_block_input_name(const zd_block *block, int input)
{
    return zd_is_in(input, zd_block_inputs(block)) ? zd_block_text(&block->layout, *input_of(block, input)) : NULL;
}

double zd_block_input(const zd_block *block, int input)
{
    if (!zd_is_in(input, zd_block_inputs(block))) return NAN;
    const double *word = input_of(block, input);
    return word[2] == ZD_INPUT_FORCE ? block->force[(int)word[3]].value : row_of(block, (int)word[3])->slope;
}

int zd_block_set_input(zd_block *block, int input, double t, double value)
{
    if (!zd_is_in(input, zd_block_inputs(block)) || !isfinite(value)) return ZD_BAD_ARGUMENT;
    const double *word = input_of(block, input);
    if (word[2] == ZD_INPUT_FORCE) {
        block->force[(int)word[3]].value = value;
        return ZD_DONE;
    }
    zd_relation *row = row_of(block, (int)word[3]);
    if (!row->nonholonomic) row->constant += (row->slope - value) * t;     /* the driven value at t stays */
    row->slope = value;
    return ZD_DONE;
}

/* ---- parameters ---- */

static const double MOST = 9;       /* exponents are below it */

static int effect_is_right(const zd_block_layout *layout, const double *effect)
{
    const zd_block_part *last = layout->part + ZD_BLOCK_START;
    const double start = (double)(last->word - layout->part[ZD_BLOCK_GRAVITY].word) + ZD_BLOCK_HEADER;
    const double products = layout->part[ZD_BLOCK_PRODUCTS].count;
    return zd_block_is_whole(effect[0], ZD_BLOCK_HEADER, start) && zd_block_is_whole(effect[1], 0, products) &&
           zd_block_is_whole(effect[2], 1, products - effect[1] + 1);
}

static int product_is_right(const zd_block_layout *layout, const double *product)
{
    for (int i = 1; i < 7; i += 2)
        if (!zd_block_is_whole(product[i], 0, layout->part[ZD_BLOCK_PARAMETERS].count) || !zd_block_is_whole(product[i + 1], 0, MOST))
            return 0;
    return 1;
}

int zd_block_parameters_check(const zd_block_layout *layout, zd_complaint to)
{
    for (int i = 0; i < layout->part[ZD_BLOCK_PARAMETERS].count; i++) {
        const double *word = zd_block_entry(layout, ZD_BLOCK_PARAMETERS, i);
        if (!zd_block_text(layout, word[0]) || !zd_block_text(layout, word[1]) || !(word[3] <= word[2] && word[2] <= word[4]))
            return zd_complain(to, "parameter %d: its texts must exist, and its value be in its range", i);
    }
    for (int i = 0; i < layout->part[ZD_BLOCK_EFFECTS].count; i++)
        if (!effect_is_right(layout, zd_block_entry(layout, ZD_BLOCK_EFFECTS, i)))
            return zd_complain(to, "effect %d: its word must be one of the tables, and its products exist", i);
    for (int i = 0; i < layout->part[ZD_BLOCK_PRODUCTS].count; i++)
        if (!product_is_right(layout, zd_block_entry(layout, ZD_BLOCK_PRODUCTS, i)))
            return zd_complain(to, "product %d: its parameters must exist, and exponents be from 0 to 8", i);
    return 1;
}

int zd_block_parameters(const zd_block *block) { return block->layout.part[ZD_BLOCK_PARAMETERS].count; }

const char *zd_block_parameter_name(const zd_block *block, int parameter)
{
    if (!zd_is_in(parameter, zd_block_parameters(block))) return NULL;
    return zd_block_text(&block->layout, *zd_block_entry(&block->layout, ZD_BLOCK_PARAMETERS, parameter));
}

static double product_value(const zd_block_layout *layout, const double *product)
{
    double value = product[0];
    for (int i = 1; i < 7; i += 2)
        for (int k = 0; k < (int)product[i + 1]; k++) value *= zd_block_entry(layout, ZD_BLOCK_PARAMETERS, (int)product[i])[2];
    return value;
}

/* True if one of the products of an effect has a power of the parameter. */
static int depends_on(const zd_block_layout *layout, const double *effect, int parameter)
{
    for (int i = 0; i < (int)effect[2]; i++) {
        const double *product = zd_block_entry(layout, ZD_BLOCK_PRODUCTS, (int)effect[1] + i);
        for (int k = 1; k < 7; k += 2)
            if (product[k] == parameter && product[k + 1] > 0) return 1;
    }
    return 0;
}

int zd_block_set_parameter(zd_block *block, int parameter, double value)
{
    const zd_block_layout *layout = &block->layout;
    if (!zd_is_in(parameter, zd_block_parameters(block))) return ZD_BAD_ARGUMENT;
    const double *own = zd_block_entry(layout, ZD_BLOCK_PARAMETERS, parameter);
    if (!(own[3] <= value && value <= own[4])) return ZD_BAD_ARGUMENT;
    block->word[own - block->word + 2] = value;
    for (int i = 0; i < layout->part[ZD_BLOCK_EFFECTS].count; i++) {
        const double *effect = zd_block_entry(layout, ZD_BLOCK_EFFECTS, i);
        if (!depends_on(layout, effect, parameter)) continue;
        double sum = 0;
        for (int k = 0; k < (int)effect[2]; k++)
            sum += product_value(layout, zd_block_entry(layout, ZD_BLOCK_PRODUCTS, (int)effect[1] + k));
        block->word[(int)effect[0]] = sum;
    }
    return ZD_DONE;
}
