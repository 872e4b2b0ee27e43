/* Structures of mechanisms that entries of a block become. */
#ifndef ZD_BLOCK_STRUCTURES_H
#define ZD_BLOCK_STRUCTURES_H

#include "block.h"

/* A member of a structure, or several of one type in sequence. */
enum zd_block_member { ZD_MEMBER_END, ZD_MEMBER_DOUBLES, ZD_MEMBER_INT, ZD_MEMBER_TEXT };

typedef struct zd_block_field {
    enum zd_block_member member;
    size_t offset;
    int count;
} zd_block_field;

typedef struct zd_block_structure {
    size_t size;
    const zd_block_field *field;    /* ended by ZD_MEMBER_END */
} zd_block_structure;

/* Structure of the terms, relations, forces or measures. */
const zd_block_structure *zd_block_structure_of(int section);

/* Members of a structure. */
#define ZD_DOUBLES_FIELD(type, member, count) {ZD_MEMBER_DOUBLES, offsetof(type, member), count}
#define ZD_INT_FIELD(type, member) {ZD_MEMBER_INT, offsetof(type, member), 1}
#define ZD_TEXT_FIELD(type, member) {ZD_MEMBER_TEXT, offsetof(type, member), 1}
#define ZD_END_FIELD {ZD_MEMBER_END, 0, 0}
#define ZD_STRUCTURE(type, ...) {sizeof(type), (const zd_block_field[]){__VA_ARGS__, ZD_END_FIELD}}

#endif
