/* Inputs: forces and speeds that are set between steps. Parameters: numbers on which words of the block depend. */
#include <math.h>

#include "made.h"

/* ---- inputs ---- */

static const double *input_of(const zd_block *block, int input) { return zd_block_entry(&block->layout, ZD_BLOCK_INPUTS, input); }

/* True if a law has three numbers first that do not stand for splines. */
static int takes_speed(const zd_expressions *law)
{
    for (const zd_instruction *next = law->first; next->code != ZD_CODE_END; next++)
        if (next->code == ZD_CODE_SPLINE && next->a < 3) return 0;
    return law->numbers >= 3;
}

static int is_settable(const zd_block *block, const double *input)
{
    if (zd_block_is(input[2], ZD_INPUT_SPEED))
        return zd_block_is_integer(input[3], 0, zd_block_count(&block->layout, ZD_BLOCK_LAWS)) &&
               takes_speed(block->laws.law + (int)input[3]);
    return zd_block_is(input[2], ZD_INPUT_FORCE) && zd_block_is_integer(input[3], 0, zd_block_count(&block->layout, ZD_BLOCK_FORCES)) &&
           block->force[(int)input[3]].kind == ZD_FORCE_CONSTANT;
}

int zd_block_inputs_check(const zd_block *block, zd_complaint to)
{
    const zd_block_layout *layout = &block->layout;
    for (int i = 0; i < zd_block_inputs(block); i++) {
        const double *input = input_of(block, i);
        if (!zd_block_text(layout, input[0]) || !zd_block_text(layout, input[1]))
            return zd_complain(to, "input %d: the texts of its name and unit must exist", i);
        if (!is_settable(block, input))
            return zd_complain(to, "input %d: it must be a speed of a law, or set an existing force without a user function", i);
    }
    return 1;
}

void zd_block_inputs_begin(zd_block *block)
{
    zd_block_inputs_memory *memory = &block->inputs_memory;
    const int count = zd_block_inputs(block);
    for (int i = 0; i < count; i++) {
        const double *input = input_of(block, i);
        const int is_speed = zd_block_is(input[2], ZD_INPUT_SPEED), index = (int)input[3];
        double *place = is_speed ? (double *)(uintptr_t)block->laws.program[index].numbers : &block->force[index].value;
        memory->value[i] = *place = input[4];
        memory->lower[i] = -INFINITY;
        memory->upper[i] = INFINITY;
        memory->place[i] = (zd_input_slot){i, is_speed, place};
    }
    block->inputs = (zd_inputs){.count = count, .value = memory->value, .lower = memory->lower, .upper = memory->upper, .places = count,
                                .place = memory->place};
}

void zd_block_inputs_write(zd_block *block)
{
    for (const zd_input_slot *place = block->inputs.place; place < block->inputs.place + block->inputs.places; place++) {
        place->place[0] = block->inputs.value[place->input];
        if (place->is_speed) place->place[1] = place->place[2] = 0;
    }
}

int zd_block_inputs(const zd_block *block) { return zd_block_count(&block->layout, ZD_BLOCK_INPUTS); }

const char *zd_block_input_name(const zd_block *block, int input)
{
    return zd_is_in(input, zd_block_inputs(block)) ? zd_block_text(&block->layout, *input_of(block, input)) : NULL;
}

const char *zd_block_input_unit(const zd_block *block, int input)
{
    return zd_is_in(input, zd_block_inputs(block)) ? zd_block_text(&block->layout, input_of(block, input)[1]) : NULL;
}

double zd_block_input(const zd_block *block, int input)
{
    return zd_is_in(input, zd_block_inputs(block)) ? block->inputs_memory.value[input] : NAN;
}

int zd_block_set_input(zd_block *block, int input, double value)
{
    if (!zd_is_in(input, zd_block_inputs(block)) || !isfinite(value)) return ZD_BAD_INPUT;
    block->inputs_memory.value[input] = value;
    return ZD_DONE;
}

/* ---- parameters ---- */

static const double MOST = 9;       /* exponents are below it */

static int effect_is_right(const zd_block_layout *layout, const double *effect)
{
    const zd_block_part *last = layout->part + ZD_BLOCK_START;
    const double start = (double)(last->word - layout->part[ZD_BLOCK_GRAVITY].word) + (int)ZD_BLOCK_HEADER;
    const double products = zd_block_count(layout, ZD_BLOCK_PRODUCTS);
    return zd_block_is_integer(effect[0], ZD_BLOCK_HEADER, start) && zd_block_is_integer(effect[1], 0, products) &&
           zd_block_is_integer(effect[2], 1, products - effect[1] + 1);
}

static int product_is_right(const zd_block_layout *layout, const double *product)
{
    for (int i = 1; i < 7; i += 2)
        if (!zd_block_is_integer(product[i], 0, zd_block_count(layout, ZD_BLOCK_PARAMETERS)) || !zd_block_is_integer(product[i + 1], 0, MOST))
            return 0;
    return 1;
}

int zd_block_parameters_check(const zd_block_layout *layout, zd_complaint to)
{
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_PARAMETERS); i++) {
        const double *word = zd_block_entry(layout, ZD_BLOCK_PARAMETERS, i);
        if (!zd_block_text(layout, word[0]) || !zd_block_text(layout, word[1]) || !(word[3] <= word[2] && word[2] <= word[4]))
            return zd_complain(to, "parameter %d: its texts must exist, and its value be in its range", i);
    }
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_EFFECTS); i++)
        if (!effect_is_right(layout, zd_block_entry(layout, ZD_BLOCK_EFFECTS, i)))
            return zd_complain(to, "effect %d: its word must be one of the tables, and its products exist", i);
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_PRODUCTS); i++)
        if (!product_is_right(layout, zd_block_entry(layout, ZD_BLOCK_PRODUCTS, i)))
            return zd_complain(to, "product %d: its parameters must exist, and exponents be from 0 to 8", i);
    return 1;
}

int zd_block_parameters(const zd_block *block) { return zd_block_count(&block->layout, ZD_BLOCK_PARAMETERS); }

const char *zd_block_parameter_name(const zd_block *block, int parameter)
{
    if (!zd_is_in(parameter, zd_block_parameters(block))) return NULL;
    return zd_block_text(&block->layout, *zd_block_entry(&block->layout, ZD_BLOCK_PARAMETERS, parameter));
}

double zd_block_parameter(const zd_block *block, int parameter)
{
    return zd_is_in(parameter, zd_block_parameters(block)) ? zd_block_entry(&block->layout, ZD_BLOCK_PARAMETERS, parameter)[2] : NAN;
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
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_EFFECTS); i++) {
        const double *effect = zd_block_entry(layout, ZD_BLOCK_EFFECTS, i);
        if (!depends_on(layout, effect, parameter)) continue;
        double sum = 0;
        for (int k = 0; k < (int)effect[2]; k++)
            sum += product_value(layout, zd_block_entry(layout, ZD_BLOCK_PRODUCTS, (int)effect[1] + k));
        block->word[(int)effect[0]] = sum;
    }
    return ZD_DONE;
}
