/* Members of the structures of elements, in the order of a block's words. */
#include "layout.h"

#include "../mechanisms/common/elements.h"

static const zd_block_structure both[] = {
    [ZD_BLOCK_TERMS] = ZD_STRUCTURE(zd_quantity_term,
        ZD_INT_FIELD(zd_quantity_term, quantity), ZD_DOUBLES_FIELD(zd_quantity_term, coefficient, 1)),
    [ZD_BLOCK_RELATIONS] = ZD_STRUCTURE(zd_relation,
        ZD_INT_FIELD(zd_relation, first), ZD_INT_FIELD(zd_relation, terms), ZD_INT_FIELD(zd_relation, nonholonomic),
        ZD_INT_FIELD(zd_relation, law), ZD_DOUBLES_FIELD(zd_relation, constant, 1), ZD_DOUBLES_FIELD(zd_relation, slope, 1),
        ZD_INT_FIELD(zd_relation, joint)),
    [ZD_BLOCK_FORCES] = ZD_STRUCTURE(zd_generalized_force,
        ZD_INT_FIELD(zd_generalized_force, kind), ZD_INT_FIELD(zd_generalized_force, quantity),
        ZD_DOUBLES_FIELD(zd_generalized_force, stiffness, 1), ZD_DOUBLES_FIELD(zd_generalized_force, damping, 1),
        ZD_DOUBLES_FIELD(zd_generalized_force, value, 1), ZD_INT_FIELD(zd_generalized_force, law),
        ZD_INT_FIELD(zd_generalized_force, first), ZD_INT_FIELD(zd_generalized_force, terms), ZD_INT_FIELD(zd_generalized_force,
        joint)),
    [ZD_BLOCK_MEASURES] = ZD_STRUCTURE(zd_output_spec,
        ZD_TEXT_FIELD(zd_output_spec, name), ZD_TEXT_FIELD(zd_output_spec, unit), ZD_INT_FIELD(zd_output_spec, kind),
        ZD_INT_FIELD(zd_output_spec, index), ZD_INT_FIELD(zd_output_spec, size), ZD_DOUBLES_FIELD(zd_output_spec, scale, 1),
        ZD_INT_FIELD(zd_output_spec, term)),
    [ZD_BLOCK_GROUPS] = ZD_STRUCTURE(zd_element_group,
        ZD_TEXT_FIELD(zd_element_group, name), ZD_INT_FIELD(zd_element_group, owner), ZD_INT_FIELD(zd_element_group, index),
        ZD_INT_FIELD(zd_element_group, component), ZD_INT_FIELD(zd_element_group, rows), ZD_INT_FIELD(zd_element_group, kind),
        ZD_INT_FIELD(zd_element_group, sign), ZD_INT_FIELD(zd_element_group, is_active), ZD_INT_FIELD(zd_element_group, normal),
        ZD_INT_FIELD(zd_element_group, load_joint), ZD_INT_FIELD(zd_element_group, load_component),
        ZD_INT_FIELD(zd_element_group, loads),
        ZD_DOUBLES_FIELD(zd_element_group, load_factor, 4), ZD_INT_FIELD(zd_element_group, at_ends),
        ZD_DOUBLES_FIELD(zd_element_group, scale, 1), ZD_DOUBLES_FIELD(zd_element_group, value, 1),
        ZD_DOUBLES_FIELD(zd_element_group, restitution, 1),
        ZD_DOUBLES_FIELD(zd_element_group, friction, 2), ZD_INT_FIELD(zd_element_group, range), ZD_INT_FIELD(zd_element_group, opposite),
        ZD_DOUBLES_FIELD(zd_element_group, lower, 1), ZD_DOUBLES_FIELD(zd_element_group, upper, 1)),
};

const zd_block_structure *zd_block_structure_of(int section)
{
    return section >= ZD_BLOCK_TERMS && section <= ZD_BLOCK_GROUPS ? both + section : NULL;
}
