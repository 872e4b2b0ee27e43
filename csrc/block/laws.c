/* User functions of a block: programs, unpacked and checked. */
#include <string.h>

#include "made.h"

/* Entry of a law: its words and numbers, and the number of values of its frame so far. */
typedef struct law_entry {
    const zd_block_layout *layout;
    const double *word, *number;
    double first_number;        /* after the numbers of the law before: no two laws share one */
    int frame;
} law_entry;

enum { FIRST, INSTRUCTIONS, TERMS, FIRST_RESULT, RESULTS, FIRST_NUMBER, NUMBERS };      /* words of a law */

static const double *instruction_of(const law_entry *of, int i)
{
    return zd_block_entry(of->layout, ZD_BLOCK_INSTRUCTIONS, (int)of->word[FIRST] + i);
}

/* Number of instructions of the next operation, of `left` to the end of the law; 0 if one of them is wrong. */
static int operation_of(const law_entry *of, const double *word, int left)
{
    if (!zd_block_is_integer(word[0], 0, ZD_CODE_END)) return 0;
    const int is_sines = zd_block_is(word[0], ZD_CODE_SINES), most = left < ZD_SINES_AT_ONCE ? left : ZD_SINES_AT_ONCE;
    if (is_sines && !zd_block_is_integer(word[2], 1, most + 1)) return 0;
    const int count = is_sines ? (int)word[2] : 1;
    for (int i = 0; i < 4 * count; i++) {
        const int is_count = is_sines && i % 4 > 1;
        if (i % 4 == 0 ? word[i] != word[0] : !zd_block_is_integer(word[i], 0, is_count ? ZD_SINES_AT_ONCE + 1 : of->frame)) return 0;
    }
    const int has_spline = zd_block_is(word[0], ZD_CODE_SPLINE);
    if (has_spline && (word[1] >= of->word[NUMBERS] || !zd_block_is_integer(of->number[(int)word[1]], 0,
                                                                            zd_block_count(of->layout, ZD_BLOCK_SPLINES)))) return 0;
    return count;
}

/* True if `count` entries of a section, at least one, begin at `first`. */
static int has_entries(const zd_block_layout *layout, int section, double first, double count)
{
    const double all = zd_block_count(layout, section);
    return zd_block_is_integer(first, 0, all) && zd_block_is_integer(count, 1, all - first + 1);
}

/* Checks a law, and counts the values of its frame. */
static int is_right(law_entry *of, int number, zd_complaint to)
{
    const double *word = of->word;
    if (!has_entries(of->layout, ZD_BLOCK_INSTRUCTIONS, word[FIRST], word[INSTRUCTIONS]) ||
        !has_entries(of->layout, ZD_BLOCK_RESULTS, word[FIRST_RESULT], word[RESULTS]) ||
        !has_entries(of->layout, ZD_BLOCK_NUMBERS, word[FIRST_NUMBER], word[NUMBERS]) || word[FIRST_NUMBER] != of->first_number ||
        !zd_block_is_integer(word[TERMS], 0, ZD_FRAME))
        return zd_complain(to, "law %d: its instructions, results and numbers must exist, and be its own", number);
    of->number = zd_block_entry(of->layout, ZD_BLOCK_NUMBERS, (int)word[FIRST_NUMBER]);
    of->frame = (int)word[NUMBERS] + 1 + 2 * (int)word[TERMS];
    const int last = (int)word[INSTRUCTIONS] - 1;
    for (int i = 0, count; i < last; i += count) {
        count = operation_of(of, instruction_of(of, i), last - i);
        if (!count) return zd_complain(to, "law %d: the code and the operands of instruction %d must exist", number, i);
        of->frame += zd_block_is(*instruction_of(of, i), ZD_CODE_SINES) ? 2 * count : 1;
    }
    if (!zd_block_is(*instruction_of(of, last), ZD_CODE_END) || of->frame > ZD_FRAME)
        return zd_complain(to, "law %d: it must have an end, and at most %d values", number, ZD_FRAME);
    for (int i = 0; i < (int)word[RESULTS]; i++)
        if (!zd_block_is_integer(*zd_block_entry(of->layout, ZD_BLOCK_RESULTS, (int)word[FIRST_RESULT] + i), 0, of->frame))
            return zd_complain(to, "law %d: its results must be values", number);
    return 1;
}

static void unpack(zd_block_laws *self, const law_entry *of, int number)
{
    const double *word = of->word;
    zd_instruction *instruction = self->instruction + (int)word[FIRST];
    uint16_t *result = self->result + (int)word[FIRST_RESULT];
    double *numbers = self->number + (int)word[FIRST_NUMBER];
    memcpy(numbers, of->number, (size_t)word[NUMBERS] * sizeof *numbers);
    const int last = (int)word[INSTRUCTIONS] - 1;
    instruction[last].code = ZD_CODE_END;
    for (int i = 0; i < last; i++) {
        const double *from = instruction_of(of, i);
        instruction[i] = (zd_instruction){(uint16_t)from[0], (uint16_t)from[1], (uint16_t)from[2], (uint16_t)from[3]};
        self->know_time |= from[1] == word[NUMBERS] || from[2] == word[NUMBERS] || from[3] == word[NUMBERS];
        if (instruction[i].code == ZD_CODE_SPLINE)
            numbers[instruction[i].a] = (double)(uintptr_t)(self->spline + (int)of->number[instruction[i].a]);
    }
    for (int i = 0; i < (int)word[RESULTS]; i++)
        result[i] = (uint16_t)*zd_block_entry(of->layout, ZD_BLOCK_RESULTS, (int)word[FIRST_RESULT] + i);
    self->law[number] = (zd_expressions){instruction, (int)word[NUMBERS], (int)word[TERMS], (int)word[TERMS], (int)word[RESULTS], of->frame,
                                         result};
    self->program[number] = (zd_law_program){
        .expressions = self->law + number, .numbers = numbers, .has_ends = zd_expressions_have_ends(self->law + number, numbers)};
    self->have_ends |= self->program[number].has_ends;
}

static int add_spline(zd_block_laws *self, const zd_block_layout *layout, int spline, zd_complaint to)
{
    const double *word = zd_block_entry(layout, ZD_BLOCK_SPLINES, spline);
    if (!has_entries(layout, ZD_BLOCK_KNOTS, word[0], word[1]) || word[1] < 2)
        return zd_complain(to, "spline %d: it must have at least 2 knots, which must exist", spline);
    const double *knot = zd_block_entry(layout, ZD_BLOCK_KNOTS, (int)word[0]);
    for (int i = 1; i < (int)word[1]; i++)
        if (!(knot[5 * i] > knot[5 * (i - 1)])) return zd_complain(to, "spline %d: abscissas of knots must increase", spline);
    self->spline[spline] = (zd_spline){(int)word[1], knot};
    return 1;
}

void zd_block_laws_create(zd_block_laws *self, const zd_block_layout *layout, zd_arena *arena)
{
    const size_t laws = zd_block_count(layout, ZD_BLOCK_LAWS);
    self->law = zd_arena_bytes(arena, laws * sizeof *self->law);
    self->program = zd_arena_bytes(arena, laws * sizeof *self->program);
    self->instruction = zd_arena_bytes(arena, zd_block_count(layout, ZD_BLOCK_INSTRUCTIONS) * sizeof *self->instruction);
    self->result = zd_arena_bytes(arena, zd_block_count(layout, ZD_BLOCK_RESULTS) * sizeof *self->result);
    self->number = zd_arena_doubles(arena, zd_block_count(layout, ZD_BLOCK_NUMBERS));
    self->spline = zd_arena_bytes(arena, zd_block_count(layout, ZD_BLOCK_SPLINES) * sizeof *self->spline);
}

int zd_block_laws_unpack(zd_block_laws *self, const zd_block_layout *layout, zd_complaint to)
{
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_SPLINES); i++)
        if (!add_spline(self, layout, i, to)) return 0;
    law_entry of = {.layout = layout};
    for (int i = 0; i < zd_block_count(layout, ZD_BLOCK_LAWS); i++, of.first_number += of.word[NUMBERS]) {
        of.word = zd_block_entry(layout, ZD_BLOCK_LAWS, i);
        if (!is_right(&of, i, to)) return 0;
        unpack(self, &of, i);
    }
    return 1;
}

int zd_block_law_suits(const zd_block_laws *self, const zd_block_layout *layout, int law, int terms, int results)
{
    return zd_is_in(law, zd_block_count(layout, ZD_BLOCK_LAWS)) && self->law[law].terms == terms && self->law[law].results == results;
}
