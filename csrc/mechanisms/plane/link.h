/* Connection of a body to its parent in a tree of bodies, as determined by its inboard joint.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians. */
#ifndef ZD_PLANE_LINK_H
#define ZD_PLANE_LINK_H

typedef struct zd_vector {
    double x, y;
} zd_vector;

enum zd_plane_hang {
    ZD_HANGS_FREE,          /* coordinates x, y, angle */
    ZD_HANGS_FREE_POINT,    /* a free particle: x, y */
    ZD_HANGS_TURNING,       /* its angle */
    ZD_HANGS_SLIDING,       /* its displacement */
    ZD_HANGS_FIXED,
    ZD_HANGS_PINNED         /* a particle at a point of the inner body */
};

typedef struct zd_plane_link {
    enum zd_plane_hang hang;
    int inner;              /* its parent */
    int coordinate;         /* index of its first coordinate */
    zd_vector near;         /* from the inner mass centre to the joint, in the inner body's axes */
    zd_vector far;          /* from the joint to its own mass centre, in its own axes */
    zd_vector axis;         /* along which it slides, in the inner body's axes */
    double along;           /* m: position along the axis at displacement 0 */
    double angle, cosine, sine;     /* angle relative to the parent, where it slides or is fixed */
    double mass, inertia;
    double carried;         /* kg: mass of the body and all its descendants */
} zd_plane_link;

#endif
