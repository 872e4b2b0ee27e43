/* From words to sections and structures. Nothing is read before its count is known to be right. */
#include "layout.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"

static const double LARGEST = 0x1p24;       /* whole number: sums of two are far from the range of int */

static const char *const name_of_section[ZD_BLOCK_SECTIONS] = {
    "gravity", "bodies", "joints", "marker quantities", "terms", "relations", "forces", "measures", "groups", "laws", "instructions",
    "results", "numbers", "splines", "knots", "start", "outputs", "inputs", "settings", "methods", "names", "parameters", "effects",
    "products", "events", "actions", "texts"};

int zd_block_is_integer(double word, double low, double end)
{
    return word >= low && word < end && word == floor(word);
}

const zd_block_structure *zd_block_structure_in(const zd_block_layout *layout, int section)
{
    return section >= ZD_BLOCK_BODIES && section <= ZD_BLOCK_QUANTITIES ? layout->of->structure + section : zd_block_structure_of(section);
}

static int width_of(const zd_block_layout *layout, int section)
{
    static const int width[ZD_BLOCK_SECTIONS] = {
        [ZD_BLOCK_GRAVITY] = 1, [ZD_BLOCK_LAWS] = 7, [ZD_BLOCK_INSTRUCTIONS] = 4, [ZD_BLOCK_RESULTS] = 1, [ZD_BLOCK_NUMBERS] = 1,
        [ZD_BLOCK_SPLINES] = 2, [ZD_BLOCK_KNOTS] = 5,
        [ZD_BLOCK_START] = 1, [ZD_BLOCK_OUTPUTS] = 1, [ZD_BLOCK_INPUTS] = 5, [ZD_BLOCK_SETTINGS] = 9,
        [ZD_BLOCK_METHODS] = 2 + ZD_ROW_VALUES, [ZD_BLOCK_NAMES] = 1, [ZD_BLOCK_PARAMETERS] = 5, [ZD_BLOCK_EFFECTS] = 3,
        [ZD_BLOCK_PRODUCTS] = 7, [ZD_BLOCK_EVENTS] = 6, [ZD_BLOCK_ACTIONS] = 3, [ZD_BLOCK_TEXTS] = 1};
    const zd_block_structure *structure = zd_block_structure_in(layout, section);
    if (!structure) return width[section];
    int words = 0;
    for (const zd_block_field *field = structure->field; field->member; field++) words += field->count;
    return words;
}

static int header_is_right(const double *word, size_t words, zd_complaint to)
{
    if (words < ZD_BLOCK_HEADER) return zd_complain(to, "a block must have at least %d words, not %g", ZD_BLOCK_HEADER, (double)words);
    if (memcmp(word, "zdblock", sizeof *word)) return zd_complain(to, "a block must begin with \"zdblock\"");
    if (!zd_block_is(word[1], ZD_BLOCK_VERSION))
        return zd_complain(to, "the version of the block must be %d, not %g", ZD_BLOCK_VERSION, word[1]);
    if (word[2] != (double)words)
        return zd_complain(to, "the block must have the %g words that its header counts, not %g", word[2], (double)words);
    return 1;
}

/* Mechanisms of the block's dimension; NULL: this core has none. */
static const zd_block_dimension *dimension_of(const zd_block_dimension *const *known, double dimension, zd_complaint to)
{
    for (int i = 0; known[i]; i++)
        if (known[i]->dimension == dimension) return known[i];
    zd_complain(to, "the dimension of the block must be 2 or 3, and one that this core is built for, not %g", dimension);
    return NULL;
}

static int place_sections(const double *word, size_t words, zd_block_layout *to, zd_complaint complaint)
{
    size_t at = ZD_BLOCK_HEADER;
    for (int section = 0; section < ZD_BLOCK_SECTIONS; section++) {
        const double count = word[4 + section];
        const int width = width_of(to, section);
        if (!zd_block_is_integer(count, 0, LARGEST) || (size_t)count * width > words - at)
            return zd_complain(complaint, "the number of %s of the block must fit in it, and is %g", name_of_section[section], count);
        to->part[section] = (zd_block_part){(int)count, width, word + at};
        at += (size_t)count * width;
    }
    return at == words || zd_complain(complaint, "the sections of the block must fill it: %g of %g words", (double)at, (double)words);
}

static int numbers_are_finite(const zd_block_layout *layout, zd_complaint to)
{
    for (int section = 0; section < ZD_BLOCK_TEXTS; section++) {
        const zd_block_part *part = layout->part + section;
        for (int i = 0; i < part->count * part->width; i++)
            if (!isfinite(part->word[i]))
                return zd_complain(to, "%s of the block: every number must be finite, and entry %d has %g", name_of_section[section],
                                   i / part->width, part->word[i]);
    }
    return 1;
}

int zd_block_split(const double *word, size_t words, const zd_block_dimension *const *known, zd_block_layout *to, zd_complaint complaint)
{
    if (!header_is_right(word, words, complaint)) return 0;
    to->of = dimension_of(known, word[3], complaint);
    if (!to->of || !place_sections(word, words, to, complaint) || !numbers_are_finite(to, complaint)) return 0;
    if (zd_block_count(to, ZD_BLOCK_GRAVITY) != to->of->dimension + 1)
        return zd_complain(complaint, "gravity must have %d components, and a length after them", to->of->dimension);
    const zd_block_part *texts = to->part + ZD_BLOCK_TEXTS;
    if (texts->count && ((const char *)(texts->word + texts->count))[-1])
        return zd_complain(complaint, "the texts of the block must end with a zero byte");
    return 1;
}

const char *zd_block_text(const zd_block_layout *layout, double offset)
{
    const zd_block_part *texts = layout->part + ZD_BLOCK_TEXTS;
    if (!zd_block_is_integer(offset, 0, 8.0 * texts->count)) return NULL;
    return (const char *)texts->word + (size_t)offset;
}

static int unpack_field(const zd_block_layout *layout, const zd_block_field *field, const double *word, unsigned char *entry)
{
    void *to = entry + field->offset;
    if (field->member == ZD_MEMBER_DOUBLES) zd_copy_all(field->count, word, to);
    if (field->member == ZD_MEMBER_TEXT) {
        const char *text = zd_block_text(layout, *word);
        memcpy(to, &text, sizeof text);
        return text != NULL;
    }
    if (field->member == ZD_MEMBER_INT) {
        if (!zd_block_is_integer(*word, -1, LARGEST)) return 0;
        const int value = (int)*word;
        memcpy(to, &value, sizeof value);
    }
    return 1;
}

int zd_block_unpack(const zd_block_layout *layout, int section, void *to, zd_complaint complaint)
{
    const zd_block_structure *structure = zd_block_structure_in(layout, section);
    const zd_block_part *part = layout->part + section;
    const double *word = part->word;
    unsigned char *entry = to;
    for (int i = 0; i < part->count; i++, entry += structure->size)
        for (const zd_block_field *field = structure->field; field->member; word += field++->count)
            if (!unpack_field(layout, field, word, entry))
                return zd_complain(complaint, "%s of the block: entry %d must have whole numbers from -1 on and existing texts, not %g",
                                   name_of_section[section], i, *word);
    return 1;
}
