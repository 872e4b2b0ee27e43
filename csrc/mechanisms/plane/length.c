/* The size of what is drawn: how far apart points of the ground are, twice how far those of bodies are from their mass centres, and lengths
 * of joints and marker quantities. Coordinates alone do not tell it, as a slider may start at 0. */
#include "tables.h"

#include "../../linalg/roots.h"
#include "tree.h"

typedef struct extent {
    double largest;
    zd_vector low, high;    /* corners of the ground's points */
} extent;

static void extend(extent *to, int body, const double *point)
{
    if (body) {
        to->largest = fmax(to->largest, 2 * zd_hypotenuse(point[0], point[1]));
        return;
    }
    to->low = (zd_vector){fmin(to->low.x, point[0]), fmin(to->low.y, point[1])};
    to->high = (zd_vector){fmax(to->high.x, point[0]), fmax(to->high.y, point[1])};
}

double zd_plane_tables_length(const zd_plane_tables *tables)
{
    extent all = {0, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (const zd_plane_joint *joint = tables->joint; joint < tables->joint + tables->joints; joint++) {
        extend(&all, joint->first, joint->point1);
        extend(&all, joint->second, joint->point2);
        all.largest = fmax(all.largest, fmax(fabs(joint->length), fmax(fabs(joint->along), fabs(joint->across))));
    }
    for (const zd_plane_quantity *quantity = tables->quantity; quantity < tables->quantity + tables->quantities; quantity++) {
        if (quantity->kind < ZD_PLANE_ALONG) continue;     /* position vectors begin at the global origin, which may be far away */
        extend(&all, quantity->first, quantity->point1);
        extend(&all, quantity->second, quantity->point2);
        all.largest = fmax(all.largest, fabs(quantity->zero));
    }
    if (all.high.x >= all.low.x) all.largest = fmax(all.largest, zd_hypotenuse(all.high.x - all.low.x, all.high.y - all.low.y));
    return all.largest > 0 ? all.largest : 1;
}
