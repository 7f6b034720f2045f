/* Writes and reads saved states. The file has a head of fixed order, which ends with its CRC-32,
 * then packed tables of the records, the spins, the painted canvases, gas and the history of a
 * stage. Integers are little-endian. */
#include "job/state.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "asset/geometry/chart.h"
#include "base/error.h"
#include "base/file_in.h"
#include "job/state_check.h"
#include "job/state_visit.h"

#define MAGIC "kiln state "

/* The version of the file's format. The simulation has a version of its own, which the motion hash
 * covers. */
enum { FORMAT = 1, HASH_DIGITS = 64, VERSION_SIZE = 16 };

enum { RECORD_WORDS = 8, SPIN_WORDS = 8, TEXEL_WORDS = 4, SPLAT_WORDS = 12 };

/* Serials and birth words are stored as differences, since they rise from slot to slot. */
enum { RECORD_RISING = 1 << 3 | 1 << 7 };

/* The bits say which tables a system has beside its records: each has a row for each slot. */
enum { HAS_SPINS = 1, HAS_WAYS = 2 };

/* The contents of the head. */
struct head {
    struct kiln_state_info info;
    uint32_t of_whole; /* of the history */
    uint32_t system_count, canvas_count, gas_count;
    struct head_system {
        uint32_t capacity, rows; /* rows: HAS_SPINS, HAS_WAYS */
        uint64_t next_serial, birth_wait;
    } systems[KILN_MAX_SYSTEMS];
    struct kiln_canvas_shape canvases[KILN_MAX_MESHES];
    struct kiln_state_gas gas[KILN_MAX_GAS];
};

/* ---- the head: one description for writing and reading --------------------------------------- */

struct cursor {
    uint8_t bytes[KILN_STATE_MAX_HEAD];
    size_t at, size; /* size: the number of bytes that were read */
    bool writes;
    bool failed;
};

static void pass_bytes(struct cursor *c, uint8_t *value, size_t size)
{
    c->failed |= c->at + size > (c->writes ? sizeof c->bytes : c->size);
    if (c->failed)
        return;
    if (c->writes)
        memcpy(c->bytes + c->at, value, size);
    else
        memcpy(value, c->bytes + c->at, size);
    c->at += size;
}

static void pass_long(struct cursor *c, uint64_t *value, size_t size)
{
    uint8_t bytes[8];
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(*value >> (8 * i));
    pass_bytes(c, bytes, size);
    *value = 0;
    for (size_t i = 0; i < size; i++)
        *value |= (uint64_t)bytes[i] << (8 * i);
}

static void pass_word(struct cursor *c, uint32_t *value)
{
    uint64_t wide = *value;
    pass_long(c, &wide, 4);
    *value = (uint32_t)wide;
}

static void pass_gas(struct cursor *c, struct kiln_state_gas *gas)
{
    for (int i = 0; i < 3; i++) {
        pass_word(c, &gas->at[i]);
        pass_word(c, &gas->cells[i]);
    }
    pass_word(c, &gas->groups);
    pass_word(c, &gas->bricks);
    pass_word(c, &gas->fastest);
    pass_word(c, &gas->kept);
    pass_long(c, &gas->smoke, 8);
    pass_long(c, &gas->growth, 8);
    pass_long(c, &gas->due, 8);
}

/* A state without gas is as it was before states had gas: the number of domains lies in the upper
 * half of that of painted meshes. */
static void pass_counts(struct cursor *c, struct head *head)
{
    uint32_t both = head->canvas_count | head->gas_count << 16;
    pass_word(c, &head->system_count);
    pass_word(c, &both);
    head->canvas_count = both & 0xffff;
    head->gas_count = both >> 16;
    c->failed |= head->system_count > KILN_MAX_SYSTEMS || head->canvas_count > KILN_MAX_MESHES ||
                 head->gas_count > KILN_MAX_GAS;
}

static void pass_head(struct cursor *c, struct head *head)
{
    struct kiln_state_info *info = &head->info;
    pass_bytes(c, (uint8_t *)info->motion, HASH_DIGITS);
    pass_bytes(c, (uint8_t *)info->history, HASH_DIGITS);
    pass_bytes(c, (uint8_t *)info->kiln, VERSION_SIZE);
    pass_word(c, &info->step);
    pass_word(c, &info->frame);
    pass_word(c, &info->hash.lane[0]);
    pass_word(c, &info->hash.lane[1]);
    pass_long(c, &info->alive, 8);
    pass_word(c, &head->of_whole);
    pass_counts(c, head);
    for (uint32_t i = 0; i < head->system_count && !c->failed; i++) {
        struct head_system *system = &head->systems[i];
        pass_word(c, &system->capacity);
        pass_word(c, &system->rows);
        c->failed |= system->rows > (HAS_SPINS | HAS_WAYS);
        pass_long(c, &system->next_serial, 8);
        pass_long(c, &system->birth_wait, 8);
    }
    for (uint32_t i = 0; i < head->canvas_count && !c->failed; i++) {
        struct kiln_canvas_shape *canvas = &head->canvases[i];
        pass_word(c, &canvas->edge);
        pass_word(c, &canvas->slot_count);
        pass_word(c, &canvas->next);
    }
    for (uint32_t i = 0; i < head->gas_count && !c->failed; i++)
        pass_gas(c, &head->gas[i]);
}

static struct head head_of(const struct kiln_state *state)
{
    const struct kiln_pool *pool = state->pool;
    struct head head = {.info = state->info,
                        .of_whole = state->history.of_whole,
                        .system_count = pool->system_count,
                        .canvas_count = pool->canvas_count,
                        .gas_count = pool->gas_count};
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        const uint32_t rows = (system->spins ? HAS_SPINS : 0u) | (system->travels ? HAS_WAYS : 0u);
        head.systems[i] = (struct head_system){.capacity = system->capacity,
                                               .rows = pool->spins.size > 0 ? rows : 0,
                                               .next_serial = system->next_serial,
                                               .birth_wait = system->birth_wait};
    }
    for (uint32_t i = 0; i < pool->canvas_count; i++) {
        const struct kiln_canvas *canvas = &pool->canvases[i];
        head.canvases[i] = (struct kiln_canvas_shape){
            .edge = canvas->edge, .slot_count = canvas->slot_count, .next = canvas->next};
    }
    for (uint32_t i = 0; i < pool->gas_count; i++)
        head.gas[i] = kiln_state_gas_of(&pool->gas[i]);
    return head;
}

/* Writes a line of MAGIC and the format, the size of the head with its CRC, the head as pass_head
 * orders it, and the CRC. */
static bool write_head(struct kiln_temporary *file, struct head *head, struct kiln_error *error)
{
    struct cursor c = {.writes = true};
    char line[32];
    const int length = snprintf(line, sizeof line, MAGIC "%d\n", FORMAT);
    pass_bytes(&c, (uint8_t *)line, (size_t)length);
    const size_t size_at = c.at;
    uint32_t size = 0, crc;
    pass_word(&c, &size);
    pass_head(&c, head);
    const size_t end = c.at;
    size = (uint32_t)end + 4;
    c.at = size_at;
    pass_word(&c, &size);
    c.at = end;
    crc = (uint32_t)crc32_z(0, c.bytes, end);
    pass_word(&c, &crc);
    if (c.failed)
        return kiln_error_set(error, KILN_IO,
                              "%s: the head of the state, of %u systems and %u painted meshes, "
                              "takes more than %d bytes",
                              file->target, head->system_count, head->canvas_count,
                              KILN_STATE_MAX_HEAD);
    return kiln_temporary_write(file, c.bytes, c.at) || kiln_temporary_fail(file, error);
}

static bool is_hash(const char *text)
{
    return strspn(text, "0123456789abcdef") == HASH_DIGITS;
}

static bool refuse(const char *path, const char *reason, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_INVALID_INPUT, "%s: %s", path, reason);
}

/* Reads the first line and the size that follows, into the cursor. */
static bool read_start(int file, const char *path, struct cursor *c, uint32_t *size,
                       struct kiln_error *error)
{
    *size = 0;
    char line[sizeof MAGIC + 16];
    const size_t length = (size_t)snprintf(line, sizeof line, MAGIC "%d\n", FORMAT);
    *c = (struct cursor){.size = length + 4};
    if (!kiln_pack_read_bytes(file, c->bytes, c->size, path, error))
        return refuse(path, "the file is not a saved state", error);
    if (memcmp(c->bytes, MAGIC, strlen(MAGIC)) != 0)
        return refuse(path, "the file is not a saved state", error);
    if (memcmp(c->bytes, line, length) != 0)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the state has another format; this kiln reads format %d", path,
                              FORMAT);
    c->at = length;
    pass_word(c, size);
    return (*size > c->size + sizeof *size && *size <= KILN_STATE_MAX_HEAD) ||
           refuse(path, "the file is damaged", error);
}

/* Returns whether a head can be of a scene: none has more slots or larger canvases. */
static bool is_plausible(const struct head *head)
{
    uint64_t slots = 0;
    uint32_t edge = 0;
    for (uint32_t i = 0; i < head->system_count; i++)
        slots += head->systems[i].capacity;
    for (uint32_t i = 0; i < head->canvas_count; i++) {
        edge = head->canvases[i].edge > edge ? head->canvases[i].edge : edge;
        slots += head->canvases[i].slot_count;
    }
    bool gas = true;
    for (uint32_t i = 0; i < head->gas_count; i++)
        gas = gas && kiln_state_gas_is_plausible(&head->gas[i]);
    return gas && slots < UINT32_MAX && edge <= KILN_MAX_CHART;
}

static bool read_head(int file, const char *path, struct head *head, struct kiln_error *error)
{
    struct cursor c;
    uint32_t size, crc = 0;
    if (!read_start(file, path, &c, &size, error) ||
        !kiln_pack_read_bytes(file, c.bytes + c.size, size - c.size, path, error))
        return false;
    c.size = size;
    *head = (struct head){.of_whole = 0};
    pass_head(&c, head);
    const size_t end = c.at;
    pass_word(&c, &crc);
    if (c.failed || c.at != size || crc != (uint32_t)crc32_z(0, c.bytes, end) ||
        !is_hash(head->info.motion) || (head->info.history[0] && !is_hash(head->info.history)) ||
        !is_plausible(head))
        return refuse(path, "the file is damaged", error);
    for (uint32_t i = 0; i < head->system_count; i++) {
        head->info.spins[i] = (head->systems[i].rows & HAS_SPINS) != 0;
        head->info.travels[i] = (head->systems[i].rows & HAS_WAYS) != 0;
    }
    memcpy(head->info.shapes, head->canvases, sizeof head->info.shapes);
    head->info.shape_count = head->canvas_count;
    return true;
}

/* ---- the tables ------------------------------------------------------------------------------ */

static bool write_table(const struct kiln_state_visitor *v, const struct kiln_table *table,
                        struct kiln_error *error)
{
    return kiln_pack_write(table, v->threads, v->out, error);
}

static bool read_table(const struct kiln_state_visitor *v, const struct kiln_table *table,
                       struct kiln_error *error)
{
    return kiln_pack_read(table, v->threads, v->file, v->path, error);
}

static bool check_table(const struct kiln_state_visitor *v, const struct kiln_table *table,
                        struct kiln_error *error)
{
    return kiln_pack_check(table, v->file, v->path, error);
}

/* Points to the tables of a state in memory; all pointers are NULL where the tables are only
 * checked. */
struct places {
    uint32_t *records, *spins, *history;
    uint32_t *texels[KILN_MAX_MESHES], *waiting[KILN_MAX_MESHES];
    struct kiln_gas *gas[KILN_MAX_GAS];
};

static bool visit_tables(const struct kiln_state_visitor *v, const struct head *head,
                         const struct places *places, struct kiln_error *error)
{
    size_t slots = 0, spins = 0;
    for (uint32_t i = 0; i < head->system_count; i++) {
        slots += head->systems[i].capacity;
        spins += (head->systems[i].rows & HAS_SPINS) ? head->systems[i].capacity : 0;
        spins += (head->systems[i].rows & HAS_WAYS) ? head->systems[i].capacity : 0;
    }
    const struct kiln_table records = {places->records, slots, RECORD_WORDS, RECORD_RISING};
    const struct kiln_table turning = {places->spins, spins, SPIN_WORDS, 0};
    if (!v->visit(v, &records, error) || !v->visit(v, &turning, error))
        return false;
    for (uint32_t i = 0; i < head->canvas_count; i++) {
        const struct kiln_canvas_shape *canvas = &head->canvases[i];
        const struct kiln_table texels = {places->texels[i], (size_t)canvas->edge * canvas->edge,
                                          TEXEL_WORDS, 0};
        const struct kiln_table waiting = {places->waiting[i], canvas->slot_count, SPLAT_WORDS, 0};
        if (!v->visit(v, &texels, error) || !v->visit(v, &waiting, error))
            return false;
    }
    for (uint32_t i = 0; i < head->gas_count; i++) {
        if (!kiln_state_gas_visit(v, &head->gas[i], places->gas[i], error))
            return false;
    }
    const struct kiln_table history = {places->history, slots, 1, 0};
    return !head->info.history[0] || v->visit(v, &history, error);
}

/* Finds the tables of a pool in memory; `access` is the access to its buffers. */
static bool find_places(struct kiln_pool *pool, enum kiln_access access, struct places *places,
                        struct kiln_error *error)
{
    places->records = kiln_buffer_host(&pool->records, access, error);
    if (!places->records)
        return false;
    if (pool->spins.size > 0 && !(places->spins = kiln_buffer_host(&pool->spins, access, error)))
        return false;
    for (uint32_t i = 0; i < pool->canvas_count; i++) {
        places->texels[i] = (uint32_t *)pool->canvases[i].texels;
        places->waiting[i] = (uint32_t *)pool->canvases[i].pending;
    }
    for (uint32_t i = 0; i < pool->gas_count; i++) {
        places->gas[i] = &pool->gas[i];
        if (access == KILN_READ && !kiln_gas_fetch(places->gas[i], error))
            return false;
    }
    return true;
}

/* ---- writing --------------------------------------------------------------------------------- */

bool kiln_state_write(const struct kiln_state *state, const char *path, bool overwrite,
                      struct kiln_threads *threads, struct kiln_error *error)
{
    struct head head = head_of(state);
    struct places places = {.history = state->history.of_slots};
    struct kiln_temporary file = {0};
    snprintf(head.info.kiln, sizeof head.info.kiln, "%s", KILN_VERSION);
    if (!find_places(state->pool, KILN_READ, &places, error) ||
        !kiln_target_check(path, overwrite, error) || !kiln_temporary_open(&file, path, error))
        return false;
    file.durable = true; /* a later run must find it, even after a crash */
    const struct kiln_state_visitor visitor = {
        .visit = write_table, .threads = threads, .out = &file};
    if (write_head(&file, &head, error) && visit_tables(&visitor, &head, &places, error))
        return kiln_temporary_commit(&file, overwrite, error);
    kiln_temporary_discard(&file);
    return false;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Returns whether the file ends here. */
static bool is_at_end(int file, const char *path, struct kiln_error *error)
{
    uint8_t more;
    return read(file, &more, 1) == 0 || refuse(path, "the file has bytes after its end", error);
}

bool kiln_state_check(const char *path, struct kiln_state_info *info, struct kiln_error *error)
{
    size_t size;
    const int file = kiln_file_open(path, "saved state", "kiln bake", &size, error);
    if (file < 0)
        return false;
    struct head head;
    const struct places nowhere = {.records = NULL};
    const struct kiln_state_visitor visitor = {.visit = check_table, .file = file, .path = path};
    const bool ok = read_head(file, path, &head, error) &&
                    visit_tables(&visitor, &head, &nowhere, error) && is_at_end(file, path, error);
    close(file);
    if (ok)
        *info = head.info;
    return ok;
}

/* Sets a pool's counters to those of the head. The tables are read later. Fails if the pool has
 * another layout than the state's. */
static bool shape_pool(struct kiln_pool *pool, const struct head *head, const char *path,
                       struct kiln_error *error)
{
    bool fits = head->system_count == pool->system_count &&
                head->canvas_count == pool->canvas_count && head->gas_count == pool->gas_count;
    for (uint32_t i = 0; i < pool->system_count && fits; i++) {
        struct kiln_pool_system *system = &pool->systems[i];
        fits = head->systems[i].capacity == system->capacity &&
               head->info.spins[i] == system->spins && head->info.travels[i] == system->travels;
        system->next_serial = head->systems[i].next_serial;
        system->birth_wait = head->systems[i].birth_wait;
    }
    for (uint32_t i = 0; i < pool->canvas_count && fits; i++) {
        const struct kiln_canvas_shape *from = &head->canvases[i];
        struct kiln_canvas *canvas = &pool->canvases[i];
        fits = from->edge == canvas->edge && from->slot_count == canvas->slot_count;
        canvas->next = from->next;
        canvas->changes++; /* a new count makes the painted texture be uploaded again */
    }
    if (!fits)
        return refuse(path, "the state belongs to other systems", error);
    for (uint32_t i = 0; i < pool->gas_count; i++) {
        if (!kiln_state_gas_shape(&pool->gas[i], &head->gas[i], path, error))
            return false;
    }
    return true;
}

static bool read_state(struct kiln_state *state, const struct kiln_state_visitor *visitor,
                       struct kiln_error *error)
{
    struct head head;
    struct places places = {.history = state->history.of_slots};
    if (!read_head(visitor->file, visitor->path, &head, error) ||
        !shape_pool(state->pool, &head, visitor->path, error) ||
        !find_places(state->pool, KILN_OVERWRITE, &places, error))
        return false;
    state->info = head.info;
    state->history.of_whole = head.of_whole;
    if (!places.history) /* the history is the last table, and is not read if it is not wanted */
        head.info.history[0] = '\0';
    else if (!head.info.history[0])
        return refuse(visitor->path, "the state has no history of a stage", error);
    return visit_tables(visitor, &head, &places, error) &&
           kiln_state_check_pool(state->pool, head.info.step, visitor->path, error);
}

bool kiln_state_read(struct kiln_state *state, const char *path, struct kiln_threads *threads,
                     struct kiln_error *error)
{
    size_t size;
    const int file = kiln_file_open(path, "saved state", "kiln bake", &size, error);
    if (file < 0)
        return false;
    const struct kiln_state_visitor visitor = {
        .visit = read_table, .threads = threads, .file = file, .path = path};
    const bool ok = read_state(state, &visitor, error);
    close(file);
    return ok;
}
