/* Runs the bitonic sorts of UberFlow in GL, pass by pass. Each element is written by its own
 * invocation, so a pass reads one buffer and writes another; then the two change places. For the
 * variants whose constants are passed in, a table has a word for each column and each row of each
 * pass. */
#include "bench/papers/bitonic_field.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/papers/bench_layout.h"

/* Bits of a word of the tables. */
enum { PARTNER_BEFORE = 1, TAKE_GREATER = 2 };

struct kiln_bitonic_field {
    struct kiln_device *device;
    struct kiln_network network;
    enum kiln_field_constants constants;
    GLuint program;
    uint32_t rows;            /* rows that are sorted together; 0: all */
    struct kiln_buffer other; /* pairs; a pass reads them here or writes them here */
    struct kiln_buffer table; /* for each pass, a word for each column, then for each row */
    uint32_t table_count, table_sorted; /* numbers of pairs that the table was made for */
};

static uint32_t width_bits(uint32_t padded)
{
    uint32_t bits = 0;
    while (bits < 16 && (uint64_t)1 << 2 * bits < padded)
        bits++;
    return bits;
}

uint32_t kiln_bitonic_field_width(uint32_t padded)
{
    return 1u << width_bits(padded);
}

/* A pass compares partners that are `distance` apart, in blocks of `size` that are ordered in one
 * direction. */
struct pass {
    uint32_t distance, size;
};

/* Returns the word of a column or a row. The exclusive or of a column's word and a row's word gives
 * the comparator of the element where they cross. */
static uint32_t word_of(struct pass pass, uint32_t index, uint32_t sorted)
{
    uint32_t before = (index & pass.distance) != 0;
    uint32_t descending = (index & pass.size & (sorted - 1)) != 0;
    return before * PARTNER_BEFORE | (before ^ descending) * TAKE_GREATER;
}

static uint32_t *add_pass(uint32_t *words, struct pass pass, uint32_t count, uint32_t sorted)
{
    const uint32_t width = kiln_bitonic_field_width(count);
    for (uint32_t x = 0; x < width; x++)
        *words++ = word_of(pass, x, sorted);
    for (uint32_t y = 0; y < count >> width_bits(count); y++)
        *words++ = word_of(pass, y * width, sorted);
    return words;
}

static bool fill_table(struct kiln_bitonic_field *field, uint32_t count, uint32_t sorted,
                       struct kiln_error *error)
{
    if (field->table_count == count && field->table_sorted == sorted)
        return true;
    const uint32_t width = kiln_bitonic_field_width(count);
    uint32_t passes = 0;
    for (uint32_t size = 2, stage = 1; size <= sorted; size *= 2, stage++)
        passes += stage;
    kiln_buffer_reserve(&field->table, (size_t)passes * (width + count / width) * sizeof(uint32_t));
    uint32_t *words = kiln_buffer_host(&field->table, KILN_OVERWRITE, error);
    if (!words)
        return false;
    for (uint32_t size = 2; size <= sorted; size *= 2)
        for (uint32_t distance = size / 2; distance > 0; distance /= 2)
            words = add_pass(words, (struct pass){distance, size}, count, sorted);
    field->table_count = count;
    field->table_sorted = sorted;
    return true;
}

/* Binds the table of comparators, which is not needed if the kernel computes them. */
static bool bind_table(struct kiln_bitonic_field *field, uint32_t count, uint32_t sorted,
                       struct kiln_error *error)
{
    if (field->constants == KILN_FIELD_COMPUTED)
        return true;
    if (!fill_table(field, count, sorted, error))
        return false;
    GLuint table = kiln_buffer_gl(&field->table, KILN_READ, error);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, table);
    return table != 0;
}

static void run_pass(struct kiln_bitonic_field *field, struct pass pass, uint32_t number,
                     uint32_t count, uint32_t sorted)
{
    const uint32_t width = kiln_bitonic_field_width(count);
    const uint32_t elements = field->constants == KILN_FIELD_PACKED ? count / 2 : count;
    const struct kiln_network_uniform computed[] = {
        {SORT_AT_COUNT, count}, {FIELD_AT_PASS, number}, {FIELD_AT_SORTED, sorted}};
    const struct kiln_network_uniform passed[] = {
        {SORT_AT_COUNT, count},
        {SORT_AT_DISTANCE, pass.distance},
        {FIELD_AT_WIDTH, width},
        {FIELD_AT_FIRST_WORD, number * (width + count / width)}};
    const bool computes = field->constants == KILN_FIELD_COMPUTED;
    kiln_network_dispatch(field->device, field->program, computes ? computed : passed,
                          computes ? 3 : 4, elements, SORT_GROUP_SIZE);
}

static bool sort_padded(void *context, struct kiln_buffer *pairs, uint32_t count,
                        struct kiln_error *error)
{
    struct kiln_bitonic_field *field = context;
    const uint32_t width = kiln_bitonic_field_width(count);
    const bool all = field->rows == 0 || field->rows > count / width;
    const uint32_t sorted = all ? count : field->rows * width;
    if (count < 2 || sorted < 2)
        return true;
    if (field->other.size != pairs->size) {
        kiln_buffer_finish(&field->other);
        kiln_buffer_init(&field->other, field->device, pairs->size, "other sort pairs");
    }
    GLuint from = kiln_buffer_gl(pairs, KILN_READ_WRITE, error);
    GLuint to = from ? kiln_buffer_gl(&field->other, KILN_OVERWRITE, error) : 0;
    if (!to || !bind_table(field, count, sorted, error))
        return false;
    uint32_t number = 0;
    for (uint32_t size = 2; size <= sorted; size *= 2)
        for (uint32_t distance = size / 2; distance > 0; distance /= 2) {
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS, from);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS_OUT, to);
            run_pass(field, (struct pass){distance, size}, number++, count, sorted);
            GLuint written = to;
            to = from;
            from = written;
        }
    if (number % 2) /* the last pass wrote the other buffer */
        kiln_buffer_swap_gl(pairs, &field->other);
    return true;
}

struct kiln_bitonic_field *kiln_bitonic_field_create(struct kiln_device *device,
                                                     enum kiln_field_constants constants,
                                                     struct kiln_error *error)
{
    static const char *const defines[] = {
        [KILN_FIELD_COMPUTED] = "#define COMPUTED 1\n",
        [KILN_FIELD_PASSED] = "#define PASSED 1\n",
        [KILN_FIELD_PACKED] = "#define PASSED 1\n#define PACKED 1\n",
    };
    struct kiln_bitonic_field *field = calloc(1, sizeof *field);
    if (!field) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    field->device = device;
    field->constants = constants;
    kiln_buffer_init(&field->other, device, 0, "other sort pairs");
    kiln_buffer_init(&field->table, device, 0, "comparators");
    const struct kiln_network_kernel kernel = {"bench/papers/bitonic_field.comp",
                                               defines[constants], &field->program};
    if (!kiln_network_init(&field->network, device, sort_padded, field, error) ||
        !kiln_network_programs(device, &kernel, 1, error))
        kiln_bitonic_field_destroy(&field);
    return field;
}

void kiln_bitonic_field_destroy(struct kiln_bitonic_field **field)
{
    if (!*field)
        return;
    kiln_network_finish(&(*field)->network);
    kiln_buffer_finish(&(*field)->other);
    kiln_buffer_finish(&(*field)->table);
    glDeleteProgram((*field)->program);
    free(*field);
    *field = NULL;
}

struct kiln_network *kiln_bitonic_field_network(struct kiln_bitonic_field *field)
{
    return &field->network;
}

void kiln_bitonic_field_restrict(struct kiln_bitonic_field *field, uint32_t rows)
{
    field->rows = rows;
}
