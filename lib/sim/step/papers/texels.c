/* Steps particles in fragment shaders, with the state in textures. After each step the state is
 * copied into the pool's records, which the other stages and the hash read. It is copied back from
 * the records when another technique has run the step before. */
#include "gpu/integer_textures.h"
#include "shared/papers/step_layout.h"
#include "sim/step/papers/common.h"
#include "sim/step/papers/papers.h"

struct texels {
    struct kiln_sim_programs programs;
    GLuint to_records, from_records; /* programs */
    /* one texture has position and serial, the other velocity and birth */
    struct kiln_integer_textures state, next;
    uint32_t step; /* the step after which `state` is; 0: none */
};

static void finish(void *technique)
{
    struct texels *texels = technique;
    kiln_sim_programs_finish(&texels->programs);
    if (texels->to_records)
        glDeleteProgram(texels->to_records);
    if (texels->from_records)
        glDeleteProgram(texels->from_records);
    kiln_integer_textures_finish(&texels->state);
    kiln_integer_textures_finish(&texels->next);
}

static bool init(void *technique, struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_sim_params *params, struct kiln_error *error)
{
    struct texels *texels = technique;
    if (!kiln_sim_check_stage(device, params, KILN_PROBE_FRAGMENT, error))
        return false;
    struct kiln_program_params files = {.compute = "sim/step/papers/texels_copy.comp"};
    texels->to_records = kiln_program_create(device, &files, error);
    if (!texels->to_records)
        return false;
    files.defines = "#define FROM_RECORDS 1\n";
    texels->from_records = kiln_program_create(device, &files, error);
    files = (struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert",
                                         .fragment = "sim/step/papers/texels.frag"};
    return texels->from_records &&
           kiln_sim_programs_init(&texels->programs, device, scene, params, files, error);
}

static bool make_textures(struct texels *texels, struct kiln_device *device,
                          const struct kiln_pool *pool, struct kiln_error *error)
{
    const uint32_t rows = (pool->slot_count + SIM_TEXEL_ROW - 1) / SIM_TEXEL_ROW;
    if (texels->state.height == rows)
        return true;
    kiln_integer_textures_finish(&texels->state);
    kiln_integer_textures_finish(&texels->next);
    texels->step = 0;
    return kiln_integer_textures_init(&texels->state, device, 2, SIM_TEXEL_ROW, rows, "particles",
                                      error) &&
           kiln_integer_textures_init(&texels->next, device, 2, SIM_TEXEL_ROW, rows,
                                      KILN_SIM_SECOND, error);
}

/* Copies the state to or from the bound records. */
static void copy(const struct texels *texels, struct kiln_device *device, GLuint program,
                 uint32_t slots)
{
    const GLenum access = program == texels->to_records ? GL_READ_ONLY : GL_WRITE_ONLY;
    for (GLuint i = 0; i < texels->state.count; i++)
        glBindImageTexture(i, texels->state.textures[i], 0, GL_FALSE, 0, access, GL_RGBA32UI);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glUseProgram(program);
    glUniform1ui(SIM_AT_SLOTS, slots);
    kiln_device_dispatch(device, slots, SIM_GROUP_SIZE);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_FRAMEBUFFER_BARRIER_BIT);
}

static void step_system(const struct texels *texels, const struct kiln_step_params *step)
{
    const uint32_t first_row = step->base / SIM_TEXEL_ROW;
    const uint32_t last_row = (step->base + step->used - 1) / SIM_TEXEL_ROW;
    glUseProgram(kiln_sim_programs_of(&texels->programs, step));
    kiln_integer_textures_draw(&texels->next, first_row, last_row - first_row + 1);
}

static bool step_pool(void *technique, const struct kiln_sim_blocks *blocks,
                      const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t number,
                      struct kiln_error *error)
{
    struct texels *texels = technique;
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ_WRITE, error);
    if (!records)
        return false;
    if (pool->slot_count == 0)
        return true;
    if (!make_textures(texels, blocks->device, pool, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    if (texels->step == 0 || texels->step != number - 1)
        copy(texels, blocks->device, texels->from_records, pool->slot_count);
    kiln_integer_textures_bind(&texels->state, 0);
    for (uint32_t k = 0; k < params->system_count; k++) {
        uint32_t i = params->order[k];
        if (params->systems[i].used == 0)
            continue;
        kiln_sim_blocks_bind(blocks, params, i);
        step_system(texels, &params->systems[i]);
    }
    const struct kiln_integer_textures before = texels->state;
    texels->state = texels->next;
    texels->next = before;
    texels->step = number;
    copy(texels, blocks->device, texels->to_records, pool->slot_count);
    return kiln_device_check(blocks->device, "simulate", error);
}

const struct kiln_simulate_row kiln_simulate_texels_row = {
    .copies = 3,
    .size = sizeof(struct texels),
    .init = init,
    .finish = finish,
    .step = step_pool,
};
