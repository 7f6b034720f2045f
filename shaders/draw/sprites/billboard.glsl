/* What the vertex shader finds out about a particle, the geometry shader carries to the corners of
 * its quad and the fragment shader shades. */
struct billboard {
    vec4 color;   /* albedo, or the tint of a colour cell; a: opacity */
    vec4 hot;     /* emitted where the cell's heat is 1; a: 1 additive, 0 covering */
    vec4 cool;    /* emitted where it is 0; a: scale of the soft fade, 1/m */
    vec4 cells;   /* two layers of the atlas, the mix between them, level of detail */
    vec4 depth;   /* view depth, m; KILN_CELL_*; 1: literal soft formula; distance, m */
    vec4 bloom;   /* weights of equation 3.2; a: scale of the motion between the cells */
    vec4 light_0; /* light from everywhere, and how it changes along the billboard's axes (right, */
    vec4 light_x; /* up, towards the viewer): spherical harmonics of degrees 0 and 1; of light_x, a: */
    vec4 light_y; /* half the thickness in the middle, m; of light_y, a: place in the drawing order */
    vec4 light_z;
};
