/* Distance fields in the cache: written beside their place and renamed, checked when read. */
#ifndef KILN_ASSET_GEOMETRY_FIELD_FILE_H
#define KILN_ASSET_GEOMETRY_FIELD_FILE_H

#include "asset/geometry/field.h"

/* Of a field with its size, which it must have in the file, and samples to be filled. False: there
 * is no such file, or it is not whole. */
bool kiln_field_read(const char *path, struct kiln_field *field);

/* Makes missing folders. Failures are nobody's business: it is a cache. */
void kiln_field_write(const char *path, const struct kiln_field *field);

#endif
