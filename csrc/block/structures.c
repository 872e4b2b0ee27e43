/* Members of the structures of mechanisms, in the order of a block's words. */
#include "structures.h"

#include "../mechanisms/plane/tables.h"
#include "../mechanisms/space/tables.h"

#define DOUBLES(type, member, count) {ZD_MEMBER_DOUBLES, offsetof(type, member), count}
#define INT(type, member) {ZD_MEMBER_INT, offsetof(type, member), 1}
#define TEXT(type, member) {ZD_MEMBER_TEXT, offsetof(type, member), 1}
#define END {ZD_MEMBER_END, 0, 0}
#define STRUCTURE(type, ...) {sizeof(type), (const zd_block_field[]){__VA_ARGS__, END}}

static const zd_block_structure plane[] = {
    [ZD_BLOCK_BODIES] = STRUCTURE(zd_plane_body, DOUBLES(zd_plane_body, mass, 1), DOUBLES(zd_plane_body, inertia, 1),
                                  INT(zd_plane_body, is_particle), INT(zd_plane_body, inboard)),
    [ZD_BLOCK_JOINTS] = STRUCTURE(zd_plane_joint, INT(zd_plane_joint, kind), INT(zd_plane_joint, first), INT(zd_plane_joint, second),
                                  DOUBLES(zd_plane_joint, point1, 2), DOUBLES(zd_plane_joint, point2, 2),
                                  DOUBLES(zd_plane_joint, axis, 2), DOUBLES(zd_plane_joint, along, 1),
                                  DOUBLES(zd_plane_joint, across, 1), DOUBLES(zd_plane_joint, angle, 1),
                                  DOUBLES(zd_plane_joint, length, 1)),
    [ZD_BLOCK_QUANTITIES] = STRUCTURE(zd_plane_quantity, INT(zd_plane_quantity, kind), INT(zd_plane_quantity, first), INT(zd_plane_quantity, second),
                                  DOUBLES(zd_plane_quantity, point1, 2), DOUBLES(zd_plane_quantity, point2, 2),
                                  DOUBLES(zd_plane_quantity, axis, 2), DOUBLES(zd_plane_quantity, zero, 1)),
};

static const zd_block_structure space[] = {
    [ZD_BLOCK_BODIES] = STRUCTURE(zd_space_body, DOUBLES(zd_space_body, mass, 1), DOUBLES(zd_space_body, inertia, 3),
                                  INT(zd_space_body, is_particle), INT(zd_space_body, inboard)),
    [ZD_BLOCK_JOINTS] = STRUCTURE(zd_space_joint, INT(zd_space_joint, kind), INT(zd_space_joint, first), INT(zd_space_joint, second),
                                  DOUBLES(zd_space_joint, point1, 3), DOUBLES(zd_space_joint, point2, 3),
                                  DOUBLES(zd_space_joint, frame1, 9), DOUBLES(zd_space_joint, frame2, 9),
                                  DOUBLES(zd_space_joint, semiaxes, 3), DOUBLES(zd_space_joint, along, 1),
                                  DOUBLES(zd_space_joint, length, 1)),
    [ZD_BLOCK_QUANTITIES] = STRUCTURE(zd_space_quantity, INT(zd_space_quantity, kind), INT(zd_space_quantity, first), INT(zd_space_quantity, second),
                                  DOUBLES(zd_space_quantity, point1, 3), DOUBLES(zd_space_quantity, point2, 3),
                                  DOUBLES(zd_space_quantity, a, 3), DOUBLES(zd_space_quantity, o, 3), DOUBLES(zd_space_quantity, b, 3),
                                  DOUBLES(zd_space_quantity, shape, 9), DOUBLES(zd_space_quantity, zero, 1), INT(zd_space_quantity, counted)),
};

static const zd_block_structure both[] = {
    [ZD_BLOCK_TERMS] = STRUCTURE(zd_quantity_term, INT(zd_quantity_term, quantity), DOUBLES(zd_quantity_term, coefficient, 1)),
    [ZD_BLOCK_RELATIONS] = STRUCTURE(zd_relation, INT(zd_relation, first), INT(zd_relation, terms), INT(zd_relation, nonholonomic),
                                     INT(zd_relation, law), DOUBLES(zd_relation, constant, 1), DOUBLES(zd_relation, slope, 1),
                                     INT(zd_relation, joint)),
    [ZD_BLOCK_FORCES] = STRUCTURE(zd_generalized_force, INT(zd_generalized_force, kind), INT(zd_generalized_force, quantity), DOUBLES(zd_generalized_force, stiffness, 1),
                                   DOUBLES(zd_generalized_force, damping, 1), DOUBLES(zd_generalized_force, value, 1), INT(zd_generalized_force, law),
                                   INT(zd_generalized_force, first), INT(zd_generalized_force, terms), INT(zd_generalized_force, joint)),
    [ZD_BLOCK_MEASURES] = STRUCTURE(zd_output_spec, TEXT(zd_output_spec, name), TEXT(zd_output_spec, unit),
                                    INT(zd_output_spec, kind), INT(zd_output_spec, index), INT(zd_output_spec, size),
                                    DOUBLES(zd_output_spec, scale, 1), INT(zd_output_spec, term)),
};

const zd_block_structure *zd_block_structure_of(int dimension, int section)
{
    if (section >= ZD_BLOCK_BODIES && section <= ZD_BLOCK_QUANTITIES) return (dimension == 2 ? plane : space) + section;
    return section >= ZD_BLOCK_TERMS && section <= ZD_BLOCK_MEASURES ? both + section : NULL;
}
