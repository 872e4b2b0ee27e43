/* The flat block of a saved state: its header, and words by which the memory of a run differs. */
#pragma once

#include <stdint.h>
#include <string.h>

#include "run_memory.h"

#define ZD_STATE_MAGIC UINT64_C(0x316574617473647a)      /* "zdstate1" on machines with little-endian words, which others refuse */
#define ZD_STATE_END UINT64_MAX                          /* end of the entries of a block */

enum { ZD_STATE_FINGERPRINT_WORDS = 8, WORD = sizeof(uint64_t) };
enum { ALL_BYTES = 1, CHECKSUM, FINGERPRINT, UNIT = FINGERPRINT + ZD_STATE_FINGERPRINT_WORDS, SETTINGS, COORDINATES, VELOCITIES,
       PLACES, HEADER };

/* Kinds of words that differ: first word of an entry is 8 * index + kind. */
enum kind {
    NUMBERS,                /* their count, and the words */
    IN_RUN,                 /* an address in the run's memory: block, and offset from its header */
    SAME                    /* the value of a word of zd_state_system(): its index */
};

static inline uint64_t word_at(const void *memory, size_t i)
{
    uint64_t word;
    memcpy(&word, (const unsigned char *)memory + i * WORD, sizeof word);
    return word;
}

/* Words of a block; of one that is not in the image, with the record of where it has numbers, which follows it. */
static inline size_t words_of(const zd_memory *block)
{
    const size_t lines = block->image ? 0 : block->bytes / 64;
    return block->bytes / WORD + (lines + WORD - 1) / WORD;
}

/* Words at the beginning of a block that are left out: a run with phases is a copy of its present plan. */
size_t zd_state_left_out(const zd_run *run, const zd_memory *block);
uint64_t zd_state_hash(uint64_t so_far, const void *data, size_t bytes);
uint64_t zd_state_hash_settings(const zd_settings *settings);
void zd_state_write_fingerprint(const char *fingerprint, uint64_t words[ZD_STATE_FINGERPRINT_WORDS]);
/* The system of the run, of one with phases that of the first. */
static inline const zd_system *zd_state_system(const zd_run *run)
{
    return run->phases ? &run->phases->first->of->system : &run->motion.system;
}
/* Number of the words at which the plan of a phase was opened. */
static inline size_t zd_state_opening(const zd_phases *phases)
{
    return 1 + (size_t)phases->full->nq + (size_t)phases->full->nv + zd_inputs_numbers(phases->settings.inputs);
}
