/* Declares the data of a particle's billboard. A vertex shader or particles_tiled_make.comp
 * computes it (particle.glsl), the geometry shader copies it to the corners of the quad, and
 * shade.glsl shades fragments with it. */
struct billboard {
    vec4 color;   /* albedo, or the tint of a colour cell; a: opacity */
    vec4 hot;     /* light emitted where the cell's heat is 1; a: 1 additive, 0 covering */
    vec4 cool;    /* light emitted where the heat is 0; a: scale of the soft fade, 1/m, or `soft`
                   * of struct billboard_lying, below 0 */
    vec4 cells;   /* two layers of the atlas, the mix between them, level of detail */
    vec4 depth;   /* view depth, m; KILN_CELL_*; 1: literal soft formula; distance, m, or `near`
                   * of struct billboard_lying */
    vec4 bloom;   /* weights of equation 3.2; a: scale of the motion between the cells */
    /* Light as spherical harmonics of degrees 0 and 1: light from all sides, and its change along
     * the billboard's axes (right, up, towards the viewer). */
    vec4 light_0; /* a: `u` of struct billboard_rim */
    vec4 light_x; /* a: half the thickness in the middle, m */
    vec4 light_y; /* a: place in the drawing order */
    vec4 light_z; /* a: `v` of struct billboard_rim */
};

/* Returns how far the rim of a billboard reaches beyond its edges, in texture coordinates. */
vec2 rim_reach(billboard b)
{
    return b.light_0.a > 0.0 ? 0.5 / vec2(b.light_0.a, b.light_z.a) : vec2(0.0);
}
