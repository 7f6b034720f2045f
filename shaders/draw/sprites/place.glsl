/* Decides whether a particle covers a pixel, and where on the particle the pixel is.
 *
 * outline.glsl computes the rows of a particle. fragment.glsl, for quads that GL draws, and
 * particles_tiled.comp call place_covers for each pixel. All techniques decide by the same formula,
 * so that they cover the same pixels, however thin the particle is; the corners of GL's quads would
 * not do, because GL may move them by a part of a pixel. */

/* Linear functions of the pixel. x is the value at the anchor, which is a fixed place in the
 * picture; y and z are the change per pixel to the right and down. */
struct place {
    vec4 u, v; /* texture coordinates: of billboards 0..1, with SHAPES divided by the depth; of points
                * and lines px from the middle, not divided; w: the anchor's x in u and y in v, px from
                * the top left */
    vec4 q;    /* 1 / depth, 1/m; undefined without SHAPES; w: unused */
    vec2 edge; /* half edges of a point or line with its soft rim, px; of a billboard, how far its
                * rim reaches beyond 0..1, times -1 */
};

/* Returns whether the particle covers a pixel, given by its middle, px from the top left. `at`
 * becomes the texture coordinates there. `depth` comes in as the particle's; with SHAPES it becomes
 * the depth of that place on it, m. */
bool place_covers(place p, vec2 pixel, inout float depth, out vec2 at)
{
    vec2 from_anchor = pixel - vec2(p.u.w, p.v.w);
    at = vec2(p.u.x + dot(p.u.yz, from_anchor), p.v.x + dot(p.v.yz, from_anchor));
#if SHAPES
    bool stroke = p.edge.x > 0.0; /* a point or a line */
    float near = p.q.x + dot(p.q.yz, from_anchor);
    vec2 low = stroke ? -p.edge : p.edge, high = stroke ? p.edge : 1.0 - p.edge;
    depth = near > 0.0 ? 1.0 / near : 0.0;
    at = near > 0.0 ? (stroke ? at : at * depth) : high;
#else
    vec2 low = p.edge, high = 1.0 - p.edge;
#endif
    return all(greaterThanEqual(at, low)) && all(lessThan(at, high));
}
