/* This header declares technique backdrop=gl: a fragment shader casts one ray a pixel, and four a
 * pixel in tiles with edges. Its uniform blocks stay bound for solids_gl.c. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_GL_H
#define KILN_DRAW_BACKDROP_BACKDROP_GL_H

#include "draw/backdrop/backdrop_inputs.h"

struct kiln_backdrop_gl;

/* Creates the technique; NULL with an error. Scene and meshes must outlive it. */
struct kiln_backdrop_gl *kiln_backdrop_gl_create(struct kiln_device *device,
                                                 const struct kiln_scene *scene,
                                                 const struct kiln_meshes *meshes,
                                                 const struct kiln_backdrop_params *params,
                                                 struct kiln_error *error);
void kiln_backdrop_gl_destroy(struct kiln_backdrop_gl **gl);

/* Writes the sizes of the floor's and the sky's pictures. */
void kiln_backdrop_gl_pictures(const struct kiln_backdrop_gl *gl, struct kiln_picture_size *floor,
                               struct kiln_picture_size *sky);

/* Binds blocks and textures, and draws the backdrop unless is_current: the picture of the last call
 * still holds. */
bool kiln_backdrop_gl_draw(struct kiln_backdrop_gl *gl, const struct kiln_backdrop_inputs *inputs,
                           bool is_current, struct kiln_error *error);

#endif
