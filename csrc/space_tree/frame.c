/* What the tree keeps of a frame, behind all else of it. */
#include "links.h"

enum { TWIST = sizeof(zd_twist3) / sizeof(double), WAY = sizeof(zd_way3) / sizeof(double), COMPOSITE = sizeof(zd_composite3) / sizeof(double) };

int zd_tree_frame3_size(int bodies, int nv) { return nv * TWIST + (bodies + 1) * (WAY + TWIST + COMPOSITE); }

zd_tree_frame3 zd_tree_frame3_of(const zd_tree3 *tree, const zd_frame3 *frame)
{
    const int all = tree->bodies + 1;
    zd_tree_frame3 own = {.column = (zd_twist3 *)frame->carried};
    own.change = own.column + tree->nv;
    own.way = (zd_way3 *)(own.change + all);
    own.composite = (zd_composite3 *)(own.way + all);
    return own;
}
