/* Parameters of formulations, integrators and corrections: defaults and checks by the rules of their cards. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "registry.h"
#include "linalg/small.h"

zd_parameter_values zd_initial(const zd_card *card)
{
    zd_parameter_values initial = {1, {0}};
    double *value = initial.value;
    for (int i = 0; i < card->parameters; value += card->parameter[i++].size)
        zd_copy_all(card->parameter[i].size, card->parameter[i].initial, value);
    return initial;
}

double *zd_value_named(zd_parameter_values *given, const zd_card *card, const char *name)
{
    double *value = given->value;
    for (int i = 0; i < card->parameters; value += card->parameter[i++].size)
        if (!strcmp(card->parameter[i].name, name)) return value;
    return NULL;
}

/* The words of a choice: those before the colon. */
static int count_words(const char *text)
{
    int words = 0;
    for (size_t i = 0; text[i] && text[i] != ':'; i++) words += text[i] != ' ' && (i == 0 || text[i - 1] == ' ');
    return words;
}

static int is_complete(double value) { return value == floor(value); }

/* The requirement that a value violates; NULL: none. */
static const char *demanded(const zd_parameter *parameter, double value)
{
    switch (parameter->rule) {
    case ZD_POSITIVE: return value > 0 && value < INFINITY ? NULL : "finite and greater than 0";
    case ZD_NOT_NEGATIVE: return value >= 0 && value < INFINITY ? NULL : "finite and at least 0";
    case ZD_COUNT: return value >= 1 && value < 0x1p31 && is_complete(value) ? NULL : "a whole number from 1 on";
    case ZD_SWITCH: return value == 0 || value == 1 ? NULL : "0 or 1";
    case ZD_CHOICE: return value >= 0 && value < count_words(parameter->text) && is_complete(value) ? NULL : "the number of a word";
    case ZD_ANY: break;
    }
    return isfinite(value) ? NULL : "finite";
}

static int check_rules(const zd_card *card, const double *value, char *message, size_t size)
{
    for (int i = 0; i < card->parameters; i++)
        for (int k = 0; k < card->parameter[i].size; k++, value++) {
            const char *demand = demanded(&card->parameter[i], *value);
            if (!demand) continue;
            snprintf(message, size, "%s of '%s' must be %s, not %g", card->parameter[i].name, card->name, demand, *value);
            return ZD_BAD_ARGUMENT;
        }
    return ZD_DONE;
}

int zd_check_parameter_values(enum zd_table table, int row, const zd_parameter_values *given, char *message, int message_size)
{
    if (!given->given) return ZD_DONE;
    const size_t size = message_size;
    int status = check_rules(zd_entry_card(table, row), given->value, message, size);
    if (status || table != ZD_CORRECTIONS) return status;
    const zd_correction *correction = zd_correction_of(row);
    return correction->clash && correction->clash(given->value, message, size) ? ZD_BAD_ARGUMENT : ZD_DONE;
}
