/* This file sends the lit blocks of a domain to GL, lets a kernel march rays through them, and
 * fetches what the march wrote. The planes of a picture stay in GL until all domains are drawn. The
 * arrays of the host are sent from and fetched to where they are, without a copy between. */
#include "draw/volume/volume_gl.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/march_layout.h"

static_assert(sizeof(struct kiln_march) == (16 + FLAME_COLORS + 1) * sizeof(float4), "std140");
static_assert(sizeof(struct kiln_march) <= 16384, "what every GL allows a uniform block");
static_assert(VOLUME_CELL == 8 && VOLUME_FOUR == 4 && VOLUME_EDGE == 9 && GAS_BRICK == 8,
              "volume_sample.glsl");
static_assert(sizeof(struct kiln_volume_profile) == VOLUME_PROFILE_WORDS * sizeof(uint32_t) &&
                  VOLUME_PROFILE_UNIT == VOLUME_PROFILE_WORDS * sizeof(uint32_t) &&
                  VOLUME_NODE == 8,
              "volume_march.comp");

/* The storage blocks: one for each binding point. */
static const char *const LABELS[MARCH_BINDINGS] = {
    [MARCH_BIND_BLOCKS] = "blocks of gas",     [MARCH_BIND_FINER] = "detail of gas",
    [MARCH_BIND_TINTS] = "tints of gas",       [MARCH_BIND_PLACES] = "places of blocks",
    [MARCH_BIND_PLANES] = "planes of gas",     [MARCH_BIND_HALFWAY] = "half opaque gas",
    [MARCH_BIND_PROFILES] = "profiles of gas", [MARCH_BIND_TOTALS] = "work of the march",
};

struct kiln_volume_gl {
    struct kiln_device *device;
    uint32_t width, height;
    GLuint programs[2]; /* without and with profiles; 0: not made yet */
    GLuint buffers[MARCH_BINDINGS];
    size_t room[MARCH_BINDINGS]; /* bytes of the buffers */
    GLuint depth;                /* texture of the scene's depths */
    struct kiln_buffer uniforms, backdrop;
    uint32_t *tiles; /* four words of each tile that is drawn */
    uint32_t tile_count;
    size_t profile_words; /* room for profiles */
};

static size_t pixels_of(const struct kiln_volume_gl *gl)
{
    return (size_t)gl->width * gl->height;
}

static size_t tiles_of(const struct kiln_volume_gl *gl)
{
    return (size_t)kiln_tiles_along(gl->width) * kiln_tiles_along(gl->height);
}

/* Makes a program when it is first needed. */
static GLuint program_of(struct kiln_volume_gl *gl, bool profiles, struct kiln_error *error)
{
    const struct kiln_program_params params = {.compute = "draw/volume/volume_march.comp",
                                               .defines = profiles ? "#define PROFILES 1\n" : NULL};
    if (!gl->programs[profiles])
        gl->programs[profiles] = kiln_program_create(gl->device, &params, error);
    return gl->programs[profiles];
}

static bool check_device(const struct kiln_device *device, struct kiln_error *error)
{
    GLint blocks = 0;
    glGetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &blocks);
    return blocks >= MARCH_BINDINGS ||
           kiln_error_set(error, KILN_NO_DEVICE,
                          "%s: kernels may have %d storage blocks, and the march through gas needs "
                          "%d; use march=cpu",
                          device->info.name, blocks, MARCH_BINDINGS);
}

struct kiln_volume_gl *kiln_volume_gl_create(struct kiln_device *device, uint32_t width,
                                             uint32_t height, struct kiln_error *error)
{
    if (!check_device(device, error))
        return NULL;
    struct kiln_volume_gl *gl = calloc(1, sizeof *gl);
    if (!gl) {
        kiln_error_no_memory(error, "drawn gas");
        return NULL;
    }
    gl->device = device;
    gl->width = width;
    gl->height = height;
    kiln_buffer_init(&gl->uniforms, device, sizeof(struct kiln_march), "march through gas");
    kiln_buffer_init(&gl->backdrop, device, sizeof(struct kiln_draw_backdrop), "haze before gas");
    glGenBuffers(MARCH_BINDINGS, gl->buffers);
    gl->tiles = malloc(tiles_of(gl) * 4 * sizeof *gl->tiles);
    if (!gl->tiles) {
        kiln_error_no_memory(error, "drawn gas");
        kiln_volume_gl_destroy(&gl);
    } else if (!program_of(gl, false, error)) {
        kiln_volume_gl_destroy(&gl);
    }
    return gl;
}

void kiln_volume_gl_destroy(struct kiln_volume_gl **gl)
{
    struct kiln_volume_gl *g = *gl;
    if (!g)
        return;
    for (int i = 0; i < 2; i++)
        glDeleteProgram(g->programs[i]); /* 0 is ignored */
    glDeleteBuffers(MARCH_BINDINGS, g->buffers);
    kiln_buffer_finish(&g->uniforms);
    kiln_buffer_finish(&g->backdrop);
    free(g->tiles);
    free(g);
    *gl = NULL;
}

/* ---- buffers --------------------------------------------------------------------------------- */

/* Makes a buffer at least so large, and binds it to its binding point. Its contents are lost if it
 * grows. */
static bool make_room(struct kiln_volume_gl *gl, GLuint at, size_t bytes, struct kiln_error *error)
{
    const struct kiln_device_info *info = &gl->device->info;
    if (bytes > (uint64_t)info->max_storage_block_bytes)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "gas needs a storage block of %zu bytes for the %s; %s allows %lld: "
                              "use march=cpu, or a smaller picture, or larger cells",
                              bytes, LABELS[at], info->name,
                              (long long)info->max_storage_block_bytes);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, gl->buffers[at]);
    if (bytes <= gl->room[at])
        return true;
    gl->room[at] = 0;
    glBufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)bytes, NULL, GL_DYNAMIC_COPY);
    char description[96];
    snprintf(description, sizeof description, "%s, %zu bytes", LABELS[at], bytes);
    if (!kiln_device_check(gl->device, description, error))
        return false;
    kiln_device_label(gl->device, GL_BUFFER, gl->buffers[at], LABELS[at]);
    gl->room[at] = bytes;
    return true;
}

/* Sends bytes to a place in a buffer that has room for them. */
static void send(struct kiln_volume_gl *gl, GLuint at, size_t offset, const void *from,
                 size_t bytes)
{
    glBindBuffer(GL_COPY_WRITE_BUFFER, gl->buffers[at]);
    glBufferSubData(GL_COPY_WRITE_BUFFER, (GLintptr)offset, (GLsizeiptr)bytes, from);
    gl->device->traffic.to_device += bytes;
}

static void fetch(struct kiln_volume_gl *gl, GLuint at, size_t offset, void *to, size_t bytes)
{
    glBindBuffer(GL_COPY_READ_BUFFER, gl->buffers[at]);
    glGetBufferSubData(GL_COPY_READ_BUFFER, (GLintptr)offset, (GLsizeiptr)bytes, to);
    gl->device->traffic.to_host += bytes;
}

/* Fills words of a buffer. */
static void fill(const struct kiln_volume_gl *gl, GLuint at, size_t offset, size_t words,
                 GLuint word)
{
    glBindBuffer(GL_COPY_WRITE_BUFFER, gl->buffers[at]);
    glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, (GLintptr)offset,
                         (GLsizeiptr)(words * sizeof word), GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

/* Makes room for bytes and sends them. bytes 0: the kernel does not read the buffer. */
static bool upload(struct kiln_volume_gl *gl, GLuint at, const void *from, size_t bytes,
                   struct kiln_error *error)
{
    if (!make_room(gl, at, bytes > 0 ? bytes : 16, error))
        return false;
    if (bytes > 0)
        send(gl, at, 0, from, bytes);
    return true;
}

/* ---- pictures -------------------------------------------------------------------------------- */

bool kiln_volume_gl_begin(struct kiln_volume_gl *gl, struct kiln_image *depth,
                          struct kiln_error *error)
{
    const size_t pixels = pixels_of(gl);
    const float far_m = 1e9f;
    gl->depth = kiln_image_gl(depth, KILN_READ, error);
    if (!gl->depth || !make_room(gl, MARCH_BIND_PLANES, 3 * pixels * sizeof(float4), error) ||
        !make_room(gl, MARCH_BIND_HALFWAY, 2 * pixels * sizeof(float), error))
        return false;
    fill(gl, MARCH_BIND_PLANES, 0, 12 * pixels, 0);
    fill(gl, MARCH_BIND_HALFWAY, 0, pixels, FLOAT_BITS(far_m));
    fill(gl, MARCH_BIND_HALFWAY, pixels * sizeof(float), pixels, 0);
    return kiln_device_check(gl->device, "march through gas", error);
}

static float4 vector_of(const float v[3], float w)
{
    return FLOAT4(v[0], v[1], v[2], w);
}

/* Returns what the march writes and reads: MARCH_*. */
static uint32_t actions_of(const struct kiln_volume_march *m)
{
    return (m->planes.smoke ? MARCH_LIGHT : 0) | (m->planes.glow ? MARCH_GLOW : 0) |
           (m->halfway.depth_m ? MARCH_HALFWAY : 0) |
           (m->field->gas->shape.colored ? MARCH_COLORED : 0) | (m->haze ? MARCH_HAZE : 0);
}

/* Sets the uniforms of a march. */
static void describe(const struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                     struct kiln_march *to)
{
    const struct kiln_volume_field *f = m->field;
    const struct kiln_gas *gas = f->gas;
    const struct kiln_gas_place cells = f->cells, bricks = f->bricks, at = gas->at;
    const size_t cubes = VOLUME_CUBES * (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
    const bool detail = m->octaves > 0 && gas->shape.detailed;
    to->eye = vector_of(m->eye, m->near_m);
    to->right = vector_of(m->right, m->cell_m);
    to->up = vector_of(m->up, m->step);
    to->forward = vector_of(m->forward, m->scattering);
    to->pixel = FLOAT4(m->pixel_x, m->pixel_y, m->middle_x, m->middle_y);
    to->to_sun = vector_of(m->to_sun, m->intensity);
    to->sun = vector_of(m->sun, m->bloom);
    to->albedo = vector_of(m->albedo, m->extinction);
    to->detail =
        FLOAT4(m->weights[0], m->weights[1], detail ? (float)m->octaves : 0.0f, m->absorption);
    to->lattice = FLOAT4((float)at.x, (float)at.y, (float)at.z, 1.0f / gas->shape.cell);
    for (int i = 0; i < 3; i++)
        to->world[i] = vector_of(m->world[i], 0.0f);
    to->cells = UINT4((uint)cells.x, (uint)cells.y, (uint)cells.z, actions_of(m));
    to->bricks = UINT4((uint)bricks.x, (uint)bricks.y, (uint)bricks.z, gl->width);
    to->picture =
        UINT4(gl->height, (uint)cubes, (uint)pixels_of(gl), (uint)(f->count * (VOLUME_BLOCK / 4)));
    memcpy(to->colors, m->colors->rgb, sizeof to->colors);
}

static bool send_uniforms(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                          struct kiln_error *error)
{
    struct kiln_march *uniforms = kiln_buffer_host(&gl->uniforms, KILN_OVERWRITE, error);
    if (!uniforms)
        return false;
    describe(gl, m, uniforms);
    const GLuint block = kiln_buffer_gl(&gl->uniforms, KILN_READ, error);
    glBindBufferBase(GL_UNIFORM_BUFFER, MARCH_BIND_UNIFORMS, block);
    if (!block || !m->haze)
        return block != 0;
    const GLuint backdrop = kiln_buffer_upload(&gl->backdrop, m->haze, error);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_BACKDROP, backdrop);
    return backdrop != 0;
}

/* Sends what detailed gas is drawn finer by: ways, then edges. */
static bool send_finer(struct kiln_volume_gl *gl, const struct kiln_volume_field *f,
                       struct kiln_error *error)
{
    const size_t ways = (size_t)f->count * VOLUME_BLOCK * sizeof(float);
    const size_t edges = (size_t)f->count * VOLUME_FOURS * sizeof(float);
    if (!make_room(gl, MARCH_BIND_FINER, ways + edges + 16, error))
        return false;
    send(gl, MARCH_BIND_FINER, 0, f->ways, ways);
    send(gl, MARCH_BIND_FINER, ways, f->edges, edges);
    return true;
}

/* Sends the blocks of a field. */
static bool send_field(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                       struct kiln_error *error)
{
    const struct kiln_volume_field *f = m->field;
    const bool detail = m->octaves > 0 && f->gas->shape.detailed, colored = f->gas->shape.colored;
    const size_t floats = (size_t)f->count * VOLUME_BLOCK, tints = (size_t)f->count * VOLUME_FOURS;
    return upload(gl, MARCH_BIND_BLOCKS, f->blocks, floats * sizeof(float), error) &&
           (detail ? send_finer(gl, f, error) : upload(gl, MARCH_BIND_FINER, NULL, 0, error)) &&
           upload(gl, MARCH_BIND_TINTS, f->tints, colored ? tints * sizeof(float) : 0, error);
}

/* Lists the tiles that blocks touch, behind the cubes. */
static bool send_places(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                        const struct kiln_volume_tiles *tiles, struct kiln_error *error)
{
    const struct kiln_gas_place bricks = m->field->bricks;
    const size_t words = VOLUME_CUBES * (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
    const uint32_t across = kiln_tiles_along(gl->width);
    gl->tile_count = 0;
    for (size_t i = 0; i < tiles_of(gl); i++) {
        const struct kiln_tile_depths depths = tiles->depths[i];
        if (!(depths.near_m < depths.far_m))
            continue;
        uint32_t *tile = gl->tiles + (size_t)gl->tile_count++ * 4;
        tile[0] = (uint32_t)i % across * VOLUME_TILE;
        tile[1] = (uint32_t)i / across * VOLUME_TILE;
        tile[2] = FLOAT_BITS(depths.near_m);
        tile[3] = FLOAT_BITS(depths.far_m);
    }
    const size_t tile_bytes = (size_t)gl->tile_count * 4 * sizeof *gl->tiles;
    if (!make_room(gl, MARCH_BIND_PLACES, words * sizeof(int32_t) + tile_bytes + 16, error))
        return false;
    send(gl, MARCH_BIND_PLACES, 0, m->field->cube_of, words * sizeof(int32_t));
    if (tile_bytes > 0)
        send(gl, MARCH_BIND_PLACES, words * sizeof(int32_t), gl->tiles, tile_bytes);
    return true;
}

/* Words of the profiles of a tile, at most. */
enum {
    PACKET_WORDS = VOLUME_PROFILE_WORDS + VOLUME_NODES + VOLUME_NODES * VOLUME_PACKET * 4,
    TILE_WORDS = VOLUME_TILE * VOLUME_TILE / VOLUME_PACKET * PACKET_WORDS,
};

/* Returns whether a march writes profiles. */
static bool writes_profiles(const struct kiln_volume_march *m)
{
    return m->profiles && m->planes.smoke;
}

/* Makes room for profiles, and empties them: for the most words that they may take in the tiles, or
 * as many as a storage block has. */
static bool begin_profiles(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                           struct kiln_error *error)
{
    const struct march_totals none = {.used = VOLUME_PROFILE_WORDS};
    const uint64_t allowed = (uint64_t)gl->device->info.max_storage_block_bytes / sizeof(uint32_t);
    const size_t least = pixels_of(gl) + VOLUME_PROFILE_WORDS + TILE_WORDS;
    const size_t most = least + (size_t)gl->tile_count * TILE_WORDS;
    if (!upload(gl, MARCH_BIND_TOTALS, &none, sizeof none, error))
        return false;
    if (!writes_profiles(m))
        return true;
    gl->profile_words = most < allowed ? most : least > allowed ? least : (size_t)allowed;
    if (!make_room(gl, MARCH_BIND_PROFILES, gl->profile_words * sizeof(uint32_t), error))
        return false;
    gl->profile_words -= pixels_of(gl);
    fill(gl, MARCH_BIND_PROFILES, 0, pixels_of(gl), VOLUME_NO_PROFILE);
    return true;
}

/* Returns the tiles whose profiles surely fit behind those that were written. */
static uint32_t tiles_that_fit(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                               uint32_t left)
{
    struct march_totals totals;
    if (!writes_profiles(m))
        return left;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    fetch(gl, MARCH_BIND_TOTALS, 0, &totals, sizeof totals);
    const size_t fit = (gl->profile_words - totals.used) / TILE_WORDS;
    return fit < left ? (uint32_t)fit : left;
}

/* Marches through all tiles, by one dispatch or, if their profiles may not fit together, several.
 */
static bool dispatch(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                     struct kiln_error *error)
{
    for (uint32_t first = 0; first < gl->tile_count;) {
        const uint32_t count = tiles_that_fit(gl, m, gl->tile_count - first);
        if (count == 0)
            return kiln_error_set(
                error, KILN_DEVICE_FAILED,
                "the profiles of gas take more than the %lld bytes that %s allows "
                "a storage block: use march=cpu, or a smaller picture",
                (long long)gl->device->info.max_storage_block_bytes, gl->device->info.name);
        glUniform2ui(MARCH_AT_TILES, first, first + count);
        kiln_device_dispatch(gl->device, count, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        first += count;
    }
    return true;
}

/* Fetches the profiles that the march wrote, and what it has done. */
static bool fetch_profiles(struct kiln_volume_gl *gl, const struct kiln_volume_march *m,
                           struct kiln_error *error)
{
    struct march_totals totals;
    const size_t head = pixels_of(gl) * sizeof(uint32_t);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    fetch(gl, MARCH_BIND_TOTALS, 0, &totals, sizeof totals);
    atomic_fetch_add(&m->counts->rays, totals.rays);
    atomic_fetch_add(&m->counts->samples, totals.samples);
    if (writes_profiles(m)) {
        const size_t bytes = (size_t)totals.used * sizeof(uint32_t);
        fetch(gl, MARCH_BIND_PROFILES, 0, m->profiles->profile_of, head);
        fetch(gl, MARCH_BIND_PROFILES, head, m->profiles->memory, bytes);
        atomic_store(&m->profiles->used, bytes);
    }
    return kiln_device_check(gl->device, "march through gas", error);
}

bool kiln_volume_gl_march(struct kiln_volume_gl *gl, const struct kiln_volume_march *march,
                          const struct kiln_volume_tiles *tiles, bool same_field,
                          struct kiln_error *error)
{
    const GLuint program = program_of(gl, writes_profiles(march), error);
    if (!program || !send_places(gl, march, tiles, error) || !begin_profiles(gl, march, error) ||
        !send_uniforms(gl, march, error) || (!same_field && !send_field(gl, march, error)))
        return false;
    for (GLuint at = 0; at < MARCH_BINDINGS; at++)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, gl->buffers[at]);
    glActiveTexture(GL_TEXTURE0 + MARCH_UNIT_DEPTH);
    glBindTexture(GL_TEXTURE_2D, gl->depth);
    glUseProgram(program);
    return dispatch(gl, march, error) && fetch_profiles(gl, march, error);
}

bool kiln_volume_gl_end(struct kiln_volume_gl *gl, const struct kiln_volume_planes *planes,
                        float *halfway_m, struct kiln_error *error)
{
    float *const to[] = {planes->smoke, planes->flame, planes->glow};
    const size_t bytes = pixels_of(gl) * sizeof(float4);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (size_t i = 0; i < 3; i++)
        if (to[i])
            fetch(gl, MARCH_BIND_PLANES, i * bytes, to[i], bytes);
    if (halfway_m)
        fetch(gl, MARCH_BIND_HALFWAY, 0, halfway_m, pixels_of(gl) * sizeof(float));
    return kiln_device_check(gl->device, "march through gas", error);
}
