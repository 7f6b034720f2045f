/* Fuzzes the reader of journals, the files that list a job's finished frames. Any bytes must give a
 * journal or an error, never a crash. Reading a journal twice must give the same frames, and the
 * settings in the head (the first line) must be within their limits. If this fails, a job that was
 * killed while it wrote its journal may not resume. */
#include "job/journal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ranges.h"
#include "fuzz.h"
#include "output/part.h"

static const struct kiln_frame_range clip = {0, 63};

/* Makes the head of the journals in the corpus, those of a job that writes 64 frames as PNG files.
 */
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

/* Opens the journal as a job does that resumes. Returns the number of frames for which the journal
 * has a state hash. */
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

/* Reads the head of the output's journal as `kiln join` does, which learns the job's settings only
 * from that head. Returns whether the head was accepted. */
static bool find_head(const char *output)
{
    struct kiln_error error = {0};
    struct kiln_journal_head head;
    struct kiln_arena *arena = kiln_arena_create();
    const bool found = arena && kiln_journal_find(output, &head, arena, &error);
    require(!arena || found || (error.code != KILN_OK && *error.message),
            "an error without a message");
    if (found) {
        const uint64_t frames = kiln_ranges_count(head.output.clip, head.output.clip_count);
        require(frames >= 1 && frames <= KILN_MAX_FRAMES, "more frames than a clip may have");
        require(kiln_parts_count(&head.output) <= frames, "more parts than frames");
    }
    kiln_arena_destroy(&arena);
    return found;
}

/* Writes a journal that has only a head, with numbers from the fuzzer's input as settings. The head
 * gets the correct hash of these settings; with a wrong hash it would be refused before its
 * settings are checked. */
static bool put_settings(const char *path, const struct kiln_journal_head *like,
                         const uint8_t *data, size_t size)
{
    uint32_t numbers[6] = {0};
    struct kiln_journal_head head;
    memcpy(numbers, data, size < sizeof numbers ? size : sizeof numbers);
    struct kiln_frame_range range = {numbers[4], numbers[5]};
    struct kiln_output_params output = like->output;
    output.width = numbers[0];
    output.height = numbers[1];
    output.fps_num = numbers[2];
    output.fps_den = numbers[3];
    output.clip = output.ranges = &range;
    FILE *file = kiln_journal_head_make(&head, &output, "fuzz", "{}") ? fopen(path, "wb") : NULL;
    if (!file)
        return false;
    struct kiln_json json = kiln_json_to_file(file);
    kiln_json_begin_object(&json, NULL);
    kiln_journal_head_write(&json, &head);
    kiln_json_end(&json);
    const bool written = kiln_json_finish(&json);
    return fclose(file) == 0 && written;
}

/* Writes a journal from the fuzzer's input. The first byte, b, decides what the other bytes are. If
 * b is even, they are the lines that follow a correct head; mutations of a whole journal would
 * rarely keep the head correct. If b mod 4 is 1, they are a whole journal. If b mod 4 is 3, they
 * are numbers for the settings of a head. */
static bool put(const char *path, const struct kiln_journal_head *head, const uint8_t *data,
                size_t size)
{
    if (data[0] % 4 == 3)
        return put_settings(path, head, data + 1, size - 1);
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
        const bool found = find_head(output);
        const uint32_t known = open_journal(&head);
        fuzz_taken = data[0] % 2 == 0 ? known > 0 : found;
        require(open_journal(&head) == known, "another answer the second time");
        unlink(path);
    }
    rmdir(folder);
    return 0;
}
