/* Settings of a run from the block: methods by name, so that tables of methods may grow. */
#include <string.h>

#include "made.h"

/* Parameters of a method as given. */
static zd_parameter_values given_of(const double *method)
{
    zd_parameter_values given = {1, {0}};
    memcpy(given.value, method + 2, sizeof given.value);
    return given;
}

static int take_method(const zd_block *block, const double *method, zd_settings *to, zd_complaint complaint)
{
    const char *name = zd_block_text(&block->layout, method[1]);
    if (!zd_block_is_integer(method[0], ZD_FORMULATIONS, ZD_CORRECTIONS + 1) || !name)
        return zd_complain(complaint, "methods of a block must be of a table of methods, and have a name");
    const enum zd_table table = (enum zd_table)(int)method[0];
    const int row = zd_entry_named(table, name);
    if (row < 0) return zd_complain(complaint, "a method must be one of this core, not '%s'", name);
    const zd_parameter_values given = given_of(method);
    if (zd_check_parameter_values(table, row, &given, complaint.message, complaint.size)) return 0;
    if (table == ZD_FORMULATIONS) to->formulation = row, to->of_formulation = given;
    if (table == ZD_INTEGRATORS) to->integrator = row, to->of_integrator = given;
    if (table == ZD_CORRECTIONS) to->correction[row] = given;
    return 1;
}

int zd_block_settings(zd_block *block, zd_settings *settings, char *message, int message_size)
{
    const zd_complaint to = {message, message_size};
    zd_block_inputs_write(block);
    const zd_block_part *methods = block->layout.part + ZD_BLOCK_METHODS, *given = block->layout.part + ZD_BLOCK_SETTINGS;
    *settings = (zd_settings){
        .formulation = zd_default_entry(ZD_FORMULATIONS), .integrator = zd_default_entry(ZD_INTEGRATORS), .step = 0.01, .save_every = 1,
        .on_singular = ZD_STOP, .outputs = block->outputs.count ? &block->outputs : NULL,
        .inputs = block->inputs.count ? &block->inputs : NULL, .events = zd_block_events_of(block), .vector = ZD_BASELINE};
    if (!methods->count) {
        const int correction = zd_default_entry(ZD_CORRECTIONS);
        settings->correction[correction] = zd_initial(zd_entry_card(ZD_CORRECTIONS, correction));
    }
    for (int i = 0; i < methods->count; i++)
        if (!take_method(block, zd_block_entry(&block->layout, ZD_BLOCK_METHODS, i), settings, to)) return ZD_BAD_ARGUMENT;
    if (!given->count) return ZD_DONE;
    const double *word = given->word;
    if (!zd_block_is_integer(word[7], 0, 0x1p53) || !zd_block_is_integer(word[8], 0, 2)) {
        zd_complain(to, "settings of a block must have a whole number of steps, and 0 or 1 for bifurcations");
        return ZD_BAD_ARGUMENT;
    }
    settings->steps = word[1] > 0 ? ZD_FIXED_STEPS : ZD_ADAPTIVE_STEPS;
    settings->t0 = word[0], settings->step = word[1], settings->rtol = word[2], settings->atol = word[3];
    settings->first_step = word[4], settings->max_step = word[5], settings->max_move = word[6], settings->max_steps = (int64_t)word[7];
    settings->on_singular = word[8] == 1 ? ZD_CONTINUE : ZD_STOP;
    return ZD_DONE;
}
