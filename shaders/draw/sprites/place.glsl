/* A particle's place in the picture: by these rows every technique finds the place of a pixel on it,
 * so all cover the same pixels, however thin it is. GL itself may move corners by a part of a pixel.
 */
struct place {
    vec4 u, v; /* 0..1 over the texture, of points and lines px from the middle: at the anchor, and */
               /* its change per pixel right and down; w: the anchor, px from the top left */
    vec4 q;    /* likewise, one over the depth; of SHAPES only */
    vec2 edge; /* half edges of a point or line with its soft rim, px; 0, 0 for billboards */
};

/* Does it cover the middle of a pixel, px from the top left? Where that is on it, and how far from
 * the eye, m, where that changes over it. */
bool place_covers(place p, vec2 pixel, inout float depth, out vec2 at)
{
    vec2 from_anchor = pixel - vec2(p.u.w, p.v.w);
    at = vec2(p.u.x + dot(p.u.yz, from_anchor), p.v.x + dot(p.v.yz, from_anchor));
#if SHAPES
    bool plain = p.edge.x > 0.0;
    float near = p.q.x + dot(p.q.yz, from_anchor);
    vec2 low = plain ? -p.edge : vec2(0.0), high = plain ? p.edge : vec2(1.0);
    depth = near > 0.0 ? 1.0 / near : 0.0;
    at = near > 0.0 ? (plain ? at : at * depth) : high;
#else
    vec2 low = vec2(0.0), high = vec2(1.0);
#endif
    return all(greaterThanEqual(at, low)) && all(lessThan(at, high));
}
