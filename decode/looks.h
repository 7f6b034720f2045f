/* Declares what readers of meshes share to fill in materials. A file may have materials that no
 * triangle uses; the result has only those that some use. */
#ifndef KILN_DECODE_LOOKS_H
#define KILN_DECODE_LOOKS_H

#include "model.h"
#include "words.h"

/* Adds a note for the user, unless there is no room or the same was noted before. */
void decode_note(char *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Gives the result as many materials as the model's parts use, each a default one, in the order of
 * their triangles, and the meshes their numbers (look). sources[] gets the number of each in the
 * file. none: the number in the file that stands for no material. */
bool decode_assign_looks(struct decode_model *model, uint32_t none,
                         uint32_t sources[KILN_MAX_MATERIALS], struct kiln_error *error);

/* Returns the number of the texture in a file, which is that of an earlier one with the same path.
 * KILN_NO_TEXTURE, with a note: the path leads elsewhere, is too long, or there are too many. */
uint32_t decode_add_file(struct decode_model *model, const char *path, size_t length);

/* Drops the textures in files that no material uses. */
void decode_drop_textures(struct kiln_looks_result *looks);

/* Returns the number of a texture whose bytes lie in the file of the mesh, which are copied.
 * KILN_NO_TEXTURE, with a note: they are too many. */
uint32_t decode_add_bytes(struct decode_model *model, const void *bytes, size_t size);

/* Stores the light of a vertex' colour, which sRGB's transfer function encodes. */
void decode_put_color(const float encoded[3], float alpha, float out[4]);

/* Returns a number between limits; the lower one for what is no number. */
float decode_clamp(float number, float least, float most);

/* Copies a name as far as it fits, without a part of a character of UTF-8 at its end. */
void decode_copy_name(const char *text, size_t length, char name[KILN_MATERIAL_NAME_SIZE]);

/* Reads the materials of a .mtl file (mtl.c): those of the result, whose names are names[]. Of two
 * with one name, the later counts. is_found[] is set for those that the file has. */
void decode_mtl(struct decode_model *model, const void *bytes, size_t size,
                const struct decode_word *names, bool *is_found);

#endif
