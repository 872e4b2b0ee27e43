/* Bodies joined by pins, in lanes: arms of the pins, and S with its factors, as schur_blocks.c and products.c for one trajectory,
 *
 *     S = C M^-1 C^T = L D L^T                                                                                            (13)
 *
 * with u and w the arms of a pin, in blocks of two rows. */

typedef struct ZD_NAMED(plane) {
    zd_real x, y;
} ZD_NAMED(plane);

ZD_KERNEL ZD_NAMED(plane) ZD_NAMED(arm_of)(const zd_lane_pins *pins, int end)
{
    const zd_stored *arm = REAL(pins->arm) + 2 * end;
    return (ZD_NAMED(plane)){arm[0], arm[1]};
}

/* ---- arms ---- */

ZD_KERNEL void ZD_NAMED(turn_body)(const zd_lanes *self, int body, const double *p)
{
    const zd_lane_pins *pins = self->pins;
    const int at = pins->of->at[body], turns = pins->of->at[body + 1] - at == 3;
    zd_real angle = turns ? (zd_real)REAL(p)[at + 2] : ZD_SPLAT(0.0), sine, cosine;
    ZD_SINES(1, &angle, &sine, &cosine);
    for (int i = pins->end_at[body]; i < pins->end_at[body + 1]; i++) {
        const int end = pins->of_body[i];
        const zd_stored *point = REAL(self->data) + pins->end[end].point;
        REAL(pins->arm)[2 * end] = ZD_FNMA(sine, point[1], cosine * point[0]);
        REAL(pins->arm)[2 * end + 1] = ZD_FMA(sine, point[0], cosine * point[1]);
    }
}

/* Computes the arms at p, unless they are known. */
ZD_KERNEL void ZD_NAMED(turn)(const zd_lanes *self, const double *p)
{
    zd_lane_pins *pins = self->pins;
    zd_condition differs = ZD_SPLAT(0.0) != 0.0;
    for (int i = 0; i < self->nq; i++) differs |= ~(REAL(p)[i] == REAL(pins->p)[i]);
    if (pins->is_turned && !ZD_ANY(differs)) return;
    for (int i = 0; i < self->nq; i++) REAL(pins->p)[i] = REAL(p)[i];
    for (int body = 0; body < pins->of->bodies; body++) ZD_NAMED(turn_body)(self, body, p);
    for (int end = 0; end < 2 * pins->count; end++) {
        if (pins->end[end].body >= 0) continue;
        const zd_stored *point = REAL(self->data) + pins->end[end].point;
        REAL(pins->arm)[2 * end] = point[0];
        REAL(pins->arm)[2 * end + 1] = point[1];
    }
    pins->is_turned = 1;
    pins->is_factored = 0;
}

/* ---- S and its factors ---- */

/* Adds the contributions of a body to the blocks of its pins. */
ZD_KERNEL void ZD_NAMED(add_body)(const zd_lanes *self, int body)
{
    const zd_lane_pins *pins = self->pins;
    const zd_real w = REAL(self->data)[2 * body], turned = REAL(self->data)[2 * body + 1];
    for (const zd_pin_pair *pair = pins->pair + pins->pair_at[body]; pair < pins->pair + pins->pair_at[body + 1]; pair++) {
        const ZD_NAMED(plane) a = ZD_NAMED(arm_of)(pins, pair->later), b = ZD_NAMED(arm_of)(pins, pair->earlier);
        const zd_real x = pair->sign * turned * a.x, y = pair->sign * turned * a.y, along = pair->sign * w;
        zd_stored *to = REAL(pins->S) + pair->at;
        const zd_real xx = ZD_FMA(y, b.y, along), xy = -y * b.x, yx = -x * b.y, yy = ZD_FMA(x, b.x, along);
        if (pair->is_first) {
            to[0] = xx, to[1] = xy, to[2] = yx, to[3] = yy;
            continue;
        }
        to[0] += xx, to[1] += xy, to[2] += yx, to[3] += yy;
    }
}

/* Diagonal block of a pin, and its diagonal before the elimination of others. */
ZD_KERNEL void ZD_NAMED(add_pin)(const zd_lanes *self, int place)
{
    const zd_lane_pins *pins = self->pins;
    zd_real xx = ZD_SPLAT(0.0), yx = xx, yy = xx;
    for (int end = 2 * place; end < 2 * place + 2; end++) {
        const int body = pins->end[end].body;
        if (body < 0) continue;
        const ZD_NAMED(plane) a = ZD_NAMED(arm_of)(pins, end);
        const zd_real w = REAL(self->data)[2 * body], x = REAL(self->data)[2 * body + 1] * a.x, y = REAL(self->data)[2 * body + 1] * a.y;
        xx += ZD_FMA(y, a.y, w);
        yx = ZD_FNMA(x, a.y, yx);
        yy += ZD_FMA(x, a.x, w);
    }
    zd_stored *to = REAL(pins->S) + 4 * place, *diagonal = REAL(pins->diagonal) + 2 * place;
    to[0] = diagonal[0] = xx;
    to[2] = yx;
    to[3] = diagonal[1] = yy;
}

/* Lanes with a pivot below ZD_GOOD_PIVOT, and below ZD_REPORTED_PIVOT. */
typedef struct ZD_NAMED(flags) {
    zd_condition small, lost;
} ZD_NAMED(flags);

/* Inverts the diagonal block of this position: D_k^-1 as in zd_invert_two(). */
ZD_KERNEL void ZD_NAMED(invert)(const zd_lane_pins *pins, int place, ZD_NAMED(flags) *flags)
{
    zd_stored *P = REAL(pins->S) + 4 * place, *diagonal = REAL(pins->diagonal) + 2 * place;
    const zd_real a = P[0], b = P[2], c = P[3], determinant = ZD_FNMA(b, b, a * c), other = a * diagonal[1];
    flags->small |= ~(a >= ZD_GOOD_PIVOT * diagonal[0]) | ~(determinant >= ZD_GOOD_PIVOT * other);
    flags->lost |= ~(a >= ZD_REPORTED_PIVOT * diagonal[0]) | ~(determinant >= ZD_REPORTED_PIVOT * other) | ~(determinant < INFINITY);
    const zd_real scale = ZD_SPLAT(1.0) / determinant;
    P[0] = c * scale;
    P[1] = P[2] = -b * scale;
    P[3] = a * scale;
}

/* Eliminates this position from the later blocks. */
ZD_KERNEL void ZD_NAMED(eliminate)(const zd_lane_pins *pins, int place)
{
    const zd_blocks *blocks = pins->blocks;
    const int first = blocks->begin[place], *target = blocks->target + blocks->target_begin[place];
    zd_stored *S = REAL(pins->S), *P = S + 4 * place;
    const zd_real aa = P[0], ab = P[1], bb = P[3];
    for (int e = first; e < blocks->begin[place + 1]; e++) {
        zd_stored *B = S + 4 * (blocks->count + e), *D = S + 4 * blocks->row[e];
        const zd_real b0 = B[0], b1 = B[1], b2 = B[2], b3 = B[3];
        const zd_real l0 = ZD_FMA(b0, aa, b1 * ab), l1 = ZD_FMA(b0, ab, b1 * bb), l2 = ZD_FMA(b2, aa, b3 * ab), l3 = ZD_FMA(b2, ab, b3 * bb);
        for (int f = first; f < e; f++) {
            const zd_stored *L = S + 4 * (blocks->count + f);
            zd_stored *to = S + *target++;
            to[0] = ZD_FNMA(b1, L[1], ZD_FNMA(b0, L[0], to[0]));
            to[1] = ZD_FNMA(b1, L[3], ZD_FNMA(b0, L[2], to[1]));
            to[2] = ZD_FNMA(b3, L[1], ZD_FNMA(b2, L[0], to[2]));
            to[3] = ZD_FNMA(b3, L[3], ZD_FNMA(b2, L[2], to[3]));
        }
        D[0] = ZD_FNMA(l1, b1, ZD_FNMA(l0, b0, D[0]));
        D[2] = ZD_FNMA(l3, b1, ZD_FNMA(l2, b0, D[2]));
        D[3] = ZD_FNMA(l3, b3, ZD_FNMA(l2, b2, D[3]));
        B[0] = l0, B[1] = l1, B[2] = l2, B[3] = l3;
    }
}

/* Forms and factors S at p, unless that is done. */
ZD_KERNEL void ZD_NAMED(factorize)(const zd_lanes *self, const double *p)
{
    zd_lane_pins *pins = self->pins;
    ZD_NAMED(turn)(self, p);
    if (pins->is_factored) return;
    for (int i = 0; i < pins->fills; i++)
        for (int j = 0; j < 4; j++) REAL(pins->S)[pins->fill[i] + j] = ZD_SPLAT(0.0);
    for (int body = 0; body < pins->of->bodies; body++) ZD_NAMED(add_body)(self, body);
    for (int place = 0; place < pins->count; place++) ZD_NAMED(add_pin)(self, place);
    ZD_NAMED(flags) flags = {ZD_SPLAT(0.0) != 0.0, ZD_SPLAT(0.0) != 0.0};
    for (int place = 0; place < pins->count; place++) {
        ZD_NAMED(invert)(pins, place, &flags);
        ZD_NAMED(eliminate)(pins, place);
    }
    *REAL(pins->is_small) = AS_NUMBER(flags.small | HOLDS(pins->refines));
    *REAL(pins->is_lost) = AS_NUMBER(flags.lost);
    pins->is_factored = 1;
}
