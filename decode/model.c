/* This file frees models. */
#include "model.h"

#include <stdlib.h>

void decode_model_finish(struct decode_model *model)
{
    for (size_t i = 0; i < model->mesh_count; i++) {
        struct decode_model_mesh *mesh = &model->meshes[i];
        free(mesh->positions);
        free(mesh->normals);
        free(mesh->uvs);
        free(mesh->triangles);
    }
    free(model->meshes);
    free(model->parts);
    *model = (struct decode_model){0};
}
