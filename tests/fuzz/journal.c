/* Fuzzes the reading of journals: any bytes are lines of this job's journal, or an error, never a
 * crash; and what is read twice is the same. */
#include "job/journal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"

static const struct kiln_frame_range clip = {0, 63};

static void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "fuzz: %s\n", what);
        abort();
    }
}

/* The job that the corpus has journals of. */
static bool make_head(struct kiln_journal_head *head, const char *output)
{
    struct kiln_error error = {0};
    const struct kiln_output_params params = {.path = output,
                                              .width = 16,
                                              .height = 16,
                                              .fps_num = 8,
                                              .fps_den = 1,
                                              .ranges = &clip,
                                              .range_count = 1,
                                              .threads = 1,
                                              .png_bits = 8,
                                              .scene_hash = "00"};
    const struct kiln_output_params complete = kiln_output_complete(&params, &error);
    return complete.format && kiln_journal_head_make(head, &complete, "fuzz", "{}");
}

/* Opens the journal as a job that goes on would. Returns how many frames it has something of. */
static uint32_t open_journal(const struct kiln_journal_head *head)
{
    struct kiln_error error = {0};
    struct kiln_records records = {0};
    bool found = false;
    uint32_t known = 0;
    require(kiln_records_create(&records, &clip, 1), "no memory for records");
    struct kiln_journal *journal =
        kiln_journal_open(head, (struct kiln_shard){0, 0}, false, &records, &found, &error);
    require(journal || (error.code != KILN_OK && *error.message), "an error without a message");
    for (uint32_t i = 0; journal && i < records.count; i++)
        known += records.items[i].has_state;
    kiln_journal_close(&journal);
    kiln_records_free(&records);
    return known;
}

/* Reads its head as whoever joins would. */
static void find_head(const char *output)
{
    struct kiln_error error = {0};
    struct kiln_journal_head head;
    struct kiln_arena *arena = kiln_arena_create();
    require(!arena || kiln_journal_find(output, &head, arena, &error) ||
                (error.code != KILN_OK && *error.message),
            "an error without a message");
    kiln_arena_destroy(&arena);
}

/* An even first byte: the rest are lines behind a head as it should be, so that changes get there.
 * An odd one: the rest is the whole journal. */
static bool put(const char *path, const struct kiln_journal_head *head, const uint8_t *data,
                size_t size)
{
    if (data[0] % 2 == 0)
        open_journal(head);
    FILE *file = fopen(path, data[0] % 2 == 0 ? "ab" : "wb");
    if (!file)
        return false;
    const bool written = fwrite(data + 1, 1, size - 1, file) == size - 1;
    return fclose(file) == 0 && written;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/kiln-fuzz-XXXXXX", output[64], path[KILN_PATH_SIZE];
    struct kiln_error error = {0};
    struct kiln_journal_head head;
    if (size == 0 || !mkdtemp(folder))
        return 0;
    snprintf(output, sizeof output, "%s/%%02d.png", folder);
    if (make_head(&head, output) &&
        kiln_journal_path(output, (struct kiln_shard){0, 0}, path, &error) &&
        put(path, &head, data, size)) {
        find_head(output);
        const uint32_t known = open_journal(&head);
        require(open_journal(&head) == known, "another answer the second time");
        unlink(path);
    }
    rmdir(folder);
    return 0;
}
