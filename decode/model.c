/* This file allocates and frees models. */
#include "model.h"

#include <stdlib.h>
#include <string.h>

bool decode_model_allocate(struct decode_model *model, size_t count)
{
    static const double unmoved[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    model->meshes = calloc(count + 1, sizeof *model->meshes);
    model->parts = calloc(count + 1, sizeof *model->parts);
    if (!model->meshes || !model->parts)
        return false;
    for (size_t i = 0; i < count; i++) {
        model->parts[i].mesh = i;
        memcpy(model->parts[i].rows, unmoved, sizeof unmoved);
    }
    model->mesh_count = model->part_count = count;
    return true;
}

void decode_model_finish(struct decode_model *model)
{
    for (size_t i = 0; i < model->mesh_count; i++) {
        struct decode_model_mesh *mesh = &model->meshes[i];
        free(mesh->positions);
        free(mesh->normals);
        free(mesh->uvs);
        free(mesh->colors);
        free(mesh->second_uvs);
        free(mesh->triangles);
    }
    free(model->meshes);
    free(model->parts);
    *model = (struct decode_model){0};
}
