/* Layout of the tree's part of a frame, which is the last part of the scratch. */
#include "links.h"

enum { TWIST = sizeof(zd_space_twist) / sizeof(double), WAY = sizeof(zd_space_way) / sizeof(double),
      COMPOSITE = sizeof(zd_space_composite) / sizeof(double) };

int zd_space_tree_frame_size(int bodies, int nv) { return nv * TWIST + (bodies + 1) * (WAY + TWIST + COMPOSITE); }

zd_space_tree_frame zd_space_tree_frame_of(const zd_space_tree *tree, const zd_space_frame *frame)
{
    const int all = tree->bodies + 1;
    zd_space_tree_frame own = {.column = (zd_space_twist *)frame->carried};
    own.change = own.column + tree->nv;
    own.way = (zd_space_way *)(own.change + all);
    own.composite = (zd_space_composite *)(own.way + all);
    return own;
}
