/* This file sorts and blends the fragments of each pixel in GL. It draws the particles once to
 * count fragments. A prefix sum on the host gives each pixel's list a place. It then draws the
 * particles again to fill the lists, once for each part of the picture whose lists fit into a fixed
 * amount of memory, so no fragment is left out. One invocation sorts a short list; long lists are
 * sorted in merge passes, so that no invocation runs more loop iterations than software GL allows.
 * Since lists are sorted, the order in which GL writes fragments does not matter. */
#include "draw/sprites/fragments_gl.h"

#include <assert.h>
#include <stdlib.h>

#include "base/error.h"
#include "draw/sprites/gas_before.h"
#include "shared/fragment_layout.h"

enum { FRAGMENTS_AT_A_TIME = 1 << 21, KEY_BYTES = 16, FRAGMENT_BYTES = 32 };

/* The most fragments of a list that an invocation blends at once on software GL; it may also sort a
 * short list. */
enum { SOFTWARE_SPAN = 1 << 14 };
static_assert(KILN_FRAGMENT_SHORT * KILN_FRAGMENT_SHORT * 7 / 10 + KILN_FRAGMENT_SHORT * 10 +
                      SOFTWARE_SPAN <
                  KILN_SOFTWARE_ITERATIONS,
              "fragments_resolve.frag");

/* Holds where a pixel's list starts, and how many of its fragments are written; `counts` has its
 * length. */
struct list_range {
    uint32_t first, written;
};

/* Describes KILN_FRAGMENT_BLOCK fragments of a long list, which one work group sorts. */
struct block {
    uint32_t pixel, first; /* first: number of its first fragment in the list */
};

enum program { LISTS, RESOLVE, MERGE, PROGRAM_COUNT };

/* Describes a rectangle of pixels whose lists are in memory together. */
struct part {
    uint32_t x, y, width, height;
    uint32_t longest; /* fragments in the longest of the lists */
};

struct kiln_fragments_gl {
    struct kiln_device *device;
    GLuint programs[PROGRAM_COUNT];
    GLint row_length[PROGRAM_COUNT], writes, span;
    GLuint vertex_array;
    struct kiln_buffer counts, ranges; /* by pixel: length of its list; struct list_range */
    struct kiln_buffer keys, fragments;
    struct kiln_buffer merged, blocks; /* for long lists: second buffer of keys; struct block */
    struct part *parts;
    size_t part_count, part_room;
};

static bool create_programs(struct kiln_fragments_gl *f,
                            const struct kiln_program_params *particles,
                            const struct kiln_scene *scene, struct kiln_error *error)
{
    for (int i = 0; i < PROGRAM_COUNT; i++) {
        struct kiln_program_params params = *particles;
        params.fragment = "draw/sprites/particles_list.frag";
        if (i == RESOLVE)
            params = (struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert",
                                                  .fragment = "draw/sprites/fragments_resolve.frag",
                                                  .defines = kiln_gas_before_defines(scene)};
        if (i == MERGE)
            params = (struct kiln_program_params){.compute = "draw/sprites/fragments_merge.comp"};
        f->programs[i] = kiln_program_create(f->device, &params, error);
        if (!f->programs[i])
            return false;
        f->row_length[i] = glGetUniformLocation(f->programs[i], "row_length");
    }
    f->writes = glGetUniformLocation(f->programs[LISTS], "writes");
    f->span = glGetUniformLocation(f->programs[RESOLVE], "span");
    return true;
}

struct kiln_fragments_gl *kiln_fragments_gl_create(struct kiln_device *device,
                                                   const struct kiln_program_params *particles,
                                                   const struct kiln_scene *scene,
                                                   struct kiln_error *error)
{
    struct kiln_fragments_gl *f = calloc(1, sizeof *f);
    if (!f) {
        kiln_error_no_memory(error, "the fragments");
        return NULL;
    }
    f->device = device;
    kiln_buffer_init(&f->counts, device, 0, "fragment counts");
    kiln_buffer_init(&f->ranges, device, 0, "fragment places");
    kiln_buffer_init(&f->keys, device, 0, "fragment keys");
    kiln_buffer_init(&f->fragments, device, 0, "fragments");
    kiln_buffer_init(&f->merged, device, 0, "merged fragment keys");
    kiln_buffer_init(&f->blocks, device, 0, "fragment blocks");
    glGenVertexArrays(1, &f->vertex_array);
    if (!create_programs(f, particles, scene, error))
        kiln_fragments_gl_destroy(&f);
    return f;
}

void kiln_fragments_gl_destroy(struct kiln_fragments_gl **fragments)
{
    struct kiln_fragments_gl *f = *fragments;
    if (!f)
        return;
    for (int i = 0; i < PROGRAM_COUNT; i++)
        glDeleteProgram(f->programs[i]); /* 0 is ignored */
    kiln_buffer_finish(&f->counts);
    kiln_buffer_finish(&f->ranges);
    kiln_buffer_finish(&f->keys);
    kiln_buffer_finish(&f->fragments);
    kiln_buffer_finish(&f->merged);
    kiln_buffer_finish(&f->blocks);
    glDeleteVertexArrays(1, &f->vertex_array);
    free(f->parts);
    free(f);
    *fragments = NULL;
}

static bool bind_buffer(struct kiln_buffer *buffer, GLuint binding, enum kiln_access access,
                        struct kiln_error *error)
{
    GLuint gl = kiln_buffer_gl(buffer, access, error);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, gl);
    return gl != 0;
}

static void use_program(const struct kiln_fragments_gl *f, enum program program,
                        const struct kiln_image *size)
{
    glUseProgram(f->programs[program]);
    glUniform1ui(f->row_length[program], size->width);
}

/* Draws the particles to count fragments or to fill lists. Colour writes are masked, since a
 * program without outputs would leave the colour targets undefined. */
static void submit_to_lists(const struct kiln_fragments_gl *f, bool writes,
                            const struct kiln_image *size, void (*submit)(void *context),
                            void *context)
{
    use_program(f, LISTS, size);
    glUniform1i(f->writes, writes);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    submit(context);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

static bool count(struct kiln_fragments_gl *f, const struct kiln_image *size,
                  void (*submit)(void *context), void *context, struct kiln_error *error)
{
    const size_t pixels = (size_t)size->width * size->height;
    const struct kiln_device_info *info = &f->device->info;
    if (pixels * sizeof(struct list_range) > (uint64_t)info->max_storage_block_bytes)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "post.compose: oit of %u x %u pixels needs a storage block of %zu "
                              "bytes; %s allows %lld: use raster=cpu, or a smaller picture",
                              size->width, size->height, pixels * sizeof(struct list_range),
                              info->name, (long long)info->max_storage_block_bytes);
    kiln_buffer_reserve(&f->counts, pixels * sizeof(uint32_t));
    kiln_buffer_reserve(&f->ranges, pixels * sizeof(struct list_range));
    if (!bind_buffer(&f->counts, KILN_BIND_FRAGMENT_COUNTS, KILN_OVERWRITE, error))
        return false;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, f->counts.gl);
    glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    submit_to_lists(f, false, size, submit, context);
    return kiln_device_check(f->device, "fragments: count", error);
}

/* ---- parts of the picture -------------------------------------------------------------------- */

static bool add_part(struct kiln_fragments_gl *f, const struct part *part, struct kiln_error *error)
{
    if (f->part_count == f->part_room) {
        size_t room = f->part_room ? 2 * f->part_room : 64;
        struct part *parts = realloc(f->parts, room * sizeof *parts);
        if (!parts) {
            kiln_error_no_memory(error, "%zu parts of the fragments", room);
            return false;
        }
        f->parts = parts;
        f->part_room = room;
    }
    f->parts[f->part_count++] = *part;
    return true;
}

/* Holds the state of dividing a picture into parts whose lists fit into memory together: whole
 * rows, or pieces of one row. */
struct partition {
    struct kiln_fragments_gl *f;
    size_t width;
    const uint32_t *counts;
    struct list_range *ranges;
    size_t limit;     /* most fragments of a part, unless one pixel alone has more */
    size_t largest;   /* most fragments of a part so far */
    struct part part; /* the part that is being made; height 0: none */
    size_t total;     /* number of its fragments so far */
};

static bool end_part(struct partition *c, struct kiln_error *error)
{
    bool ok = c->part.height == 0 || add_part(c->f, &c->part, error);
    c->largest = c->total > c->largest ? c->total : c->largest;
    c->part.height = 0;
    c->total = 0;
    return ok;
}

/* Gives the lists of `count` pixels of a row, from (x, y) on, ranges in the part. */
static void assign_ranges(struct partition *c, uint32_t x, uint32_t y, uint32_t count)
{
    for (size_t i = y * c->width + x, end = i + count; i < end; i++) {
        c->ranges[i] = (struct list_range){(uint32_t)c->total, 0};
        c->total += c->counts[i];
        c->part.longest = c->counts[i] > c->part.longest ? c->counts[i] : c->part.longest;
    }
}

/* Divides a row whose lists do not fit into memory together. */
static bool partition_row(struct partition *c, uint32_t y, struct kiln_error *error)
{
    for (uint32_t x = 0; x < c->width; x++) {
        const size_t next = c->counts[y * c->width + x];
        if (c->part.height > 0 && c->total + next > c->limit && !end_part(c, error))
            return false;
        if (c->part.height == 0)
            c->part = (struct part){x, y, 0, 1, 0};
        assign_ranges(c, x, y, 1);
        c->part.width++;
    }
    return end_part(c, error);
}

/* Divides a picture of `height` rows. */
static bool partition_picture(struct partition *c, uint32_t height, struct kiln_error *error)
{
    const uint32_t width = (uint32_t)c->width;
    for (uint32_t y = 0; y < height; y++) {
        size_t total = 0;
        for (uint32_t x = 0; x < width; x++)
            total += c->counts[y * c->width + x];
        if (c->total + total > c->limit && !end_part(c, error))
            return false;
        if (total > c->limit) {
            if (!partition_row(c, y, error))
                return false;
            continue;
        }
        if (c->part.height == 0)
            c->part = (struct part){0, y, width, 0, 0};
        assign_ranges(c, 0, y, width);
        c->part.height++;
    }
    return end_part(c, error);
}

/* Divides the picture into parts and gives each pixel's list a place in its part. Returns the
 * number of fragments of the largest part, or 0 with an error. */
static size_t scan(struct kiln_fragments_gl *f, const struct kiln_image *size,
                   struct kiln_error *error)
{
    const struct kiln_device_info *info = &f->device->info;
    const uint64_t allowed = (uint64_t)info->max_storage_block_bytes / FRAGMENT_BYTES;
    struct partition c = {
        .f = f,
        .width = size->width,
        .counts = kiln_buffer_host(&f->counts, KILN_READ, error),
        .limit = allowed < FRAGMENTS_AT_A_TIME ? (size_t)allowed : FRAGMENTS_AT_A_TIME,
        .largest = 1,
    };
    c.ranges = c.counts ? kiln_buffer_host(&f->ranges, KILN_OVERWRITE, error) : NULL;
    f->part_count = 0;
    if (!c.ranges || !partition_picture(&c, size->height, error))
        return 0;
    if (c.largest <= allowed && c.largest <= UINT32_MAX)
        return c.largest;
    kiln_error_set(error, KILN_DEVICE_FAILED,
                   "post.compose: oit: a pixel has %zu fragments; a storage block of %s takes at "
                   "most %llu: use raster=cpu, or fewer particles in one place",
                   c.largest, info->name, (unsigned long long)allowed);
    return 0;
}

/* ---- long lists ------------------------------------------------------------------------------ */

/* Writes the blocks of a part's long lists, unless `blocks` is NULL, and returns their number. */
static uint32_t list_blocks(const uint32_t *counts, uint32_t row_length, const struct part *part,
                            struct block *blocks)
{
    uint32_t number = 0;
    for (uint32_t y = part->y; y < part->y + part->height; y++) {
        for (uint32_t x = part->x; x < part->x + part->width; x++) {
            uint32_t pixel = y * row_length + x;
            if (counts[pixel] <= KILN_FRAGMENT_SHORT)
                continue;
            for (uint32_t i = 0; i < counts[pixel]; i += KILN_FRAGMENT_BLOCK, number++) {
                if (blocks)
                    blocks[number] = (struct block){pixel, i};
            }
        }
    }
    return number;
}

/* Uploads and binds the blocks of a part; returns their number, or 0 with an error. */
static uint32_t bind_blocks(struct kiln_fragments_gl *f, const struct kiln_image *size,
                            const struct part *part, struct kiln_error *error)
{
    const uint32_t *counts = kiln_buffer_host(&f->counts, KILN_READ, error);
    if (!counts)
        return 0;
    uint32_t number = list_blocks(counts, size->width, part, NULL);
    kiln_buffer_reserve(&f->blocks, number * sizeof(struct block));
    struct block *blocks = kiln_buffer_host(&f->blocks, KILN_OVERWRITE, error);
    if (!blocks)
        return 0;
    list_blocks(counts, size->width, part, blocks);
    kiln_buffer_set_content(&f->blocks, number * sizeof(struct block));
    return bind_buffer(&f->blocks, KILN_BIND_FRAGMENT_BLOCKS, KILN_READ, error) ? number : 0;
}

/* Sorts the long lists of a part. A pass merges sorted runs from one buffer of keys to the other.
 * The number of passes is even, so that the sorted keys end in `keys`, as in short lists. */
static bool sort_long_lists(struct kiln_fragments_gl *f, const struct kiln_image *size,
                            const struct part *part, struct kiln_error *error)
{
    uint32_t number = bind_blocks(f, size, part, error);
    if (number == 0)
        return false;
    kiln_buffer_reserve(&f->merged, f->keys.size);
    struct kiln_buffer *from = &f->keys, *to = &f->merged;
    glUseProgram(f->programs[MERGE]);
    glUniform1ui(KILN_AT_FRAGMENT_BLOCK_COUNT, number);
    uint32_t run = 1;
    for (uint32_t pass = 0; run < part->longest || pass % 2 > 0; pass++) {
        if (!bind_buffer(from, KILN_BIND_FRAGMENT_KEYS, KILN_READ_WRITE, error) ||
            !bind_buffer(to, KILN_BIND_FRAGMENT_MERGED, KILN_OVERWRITE, error))
            return false;
        glUniform1ui(KILN_AT_FRAGMENT_RUN, run);
        kiln_device_dispatch(f->device, number * KILN_FRAGMENT_BLOCK, KILN_FRAGMENT_BLOCK);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        struct kiln_buffer *other = from;
        from = to;
        to = other;
        run *= 2;
    }
    return bind_buffer(&f->keys, KILN_BIND_FRAGMENT_KEYS, KILN_READ_WRITE, error) &&
           kiln_device_check(f->device, "fragments: sort", error);
}

/* ---- a pass ---------------------------------------------------------------------------------- */

/* Blends the lists of a part. On software GL it blends a span of each list at a time, over the
 * result of the spans before. */
static void resolve(const struct kiln_fragments_gl *f, const struct kiln_particles_draw *draw,
                    const struct part *part)
{
    const bool software = f->device->info.software;
    uint32_t step = software ? SOFTWARE_SPAN : UINT32_MAX, from = 0;
    use_program(f, RESOLVE, draw->framebuffer->images[0]);
    do {
        uint32_t until = part->longest - from > step ? from + step : part->longest;
        for (GLuint target = 0; target < draw->framebuffer->count; target++) {
            if (from > 0 || (target == 1 && draw->keep_bloom)) {
                glEnablei(GL_BLEND, target);
                glBlendFunci(target, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
            }
        }
        glUniform2ui(f->span, from, until);
        kiln_framebuffer_fill(f->vertex_array);
        from = until;
    } while (from < part->longest);
    glDisable(GL_BLEND);
}

static bool draw_part(struct kiln_fragments_gl *f, const struct kiln_particles_draw *draw,
                      const struct part *part, void (*submit)(void *context), void *context,
                      struct kiln_error *error)
{
    const struct kiln_image *size = draw->framebuffer->images[0];
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    submit_to_lists(f, true, size, submit, context);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    if (part->longest > KILN_FRAGMENT_SHORT && !sort_long_lists(f, size, part, error))
        return false;
    resolve(f, draw, part);
    return kiln_device_check(f->device, "fragments", error);
}

bool kiln_fragments_gl_run(struct kiln_fragments_gl *fragments,
                           const struct kiln_particles_draw *draw, void (*submit)(void *context),
                           void *context, struct kiln_error *error)
{
    struct kiln_fragments_gl *f = fragments;
    const struct kiln_image *size = draw->framebuffer->images[0];
    size_t most = count(f, size, submit, context, error) ? scan(f, size, error) : 0;
    if (most == 0)
        return false;
    kiln_buffer_reserve(&f->keys, most * KEY_BYTES);
    kiln_buffer_reserve(&f->fragments, most * FRAGMENT_BYTES);
    if (!bind_buffer(&f->counts, KILN_BIND_FRAGMENT_COUNTS, KILN_READ, error) ||
        !bind_buffer(&f->ranges, KILN_BIND_FRAGMENT_RANGES, KILN_READ_WRITE, error) ||
        !bind_buffer(&f->keys, KILN_BIND_FRAGMENT_KEYS, KILN_OVERWRITE, error) ||
        !bind_buffer(&f->fragments, KILN_BIND_FRAGMENTS, KILN_OVERWRITE, error))
        return false;
    glEnable(GL_SCISSOR_TEST);
    bool ok = true;
    for (size_t i = 0; i < f->part_count && ok; i++) {
        const struct part *part = &f->parts[i];
        glScissor((GLint)part->x, (GLint)part->y, (GLsizei)part->width, (GLsizei)part->height);
        ok = draw_part(f, draw, part, submit, context, error);
    }
    glDisable(GL_SCISSOR_TEST);
    return ok;
}
