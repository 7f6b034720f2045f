/* Fuzzes the reader of sidecars, the files beside figures that record the commands by which the
 * figures were made: any bytes must give a sidecar or an error, never a crash. A sidecar that is
 * written, read and written again must give the same text. If this fails, a figure may not be made
 * again by the command that its sidecar records, or a damaged sidecar crashes kiln. */
#include <stdlib.h>
#include <string.h>

#include "figure/record.h"
#include "fuzz.h"

static void check_record(const struct kiln_record *record)
{
    require(record->command_count > 0 && record->folder, "no command");
    for (size_t i = 0; i < record->command_count; i++)
        require(record->command[i], "a word is missing");
    require(strlen(record->pixels) == 64 && strlen(record->file) == 64, "a hash is cut short");
    for (size_t i = 0; i < record->panel_count; i++)
        require(record->panels[i].label && record->panels[i].source &&
                    strlen(record->panels[i].hash) == 64,
                "a panel lacks its label, source or hash");
}

static void check_round_trip(struct kiln_arena *arena, const struct kiln_record *record)
{
    struct kiln_error error = {0};
    struct kiln_text text = {0}, text_again = {0};
    require(kiln_record_write(record, &text, &error), error.message);
    const struct kiln_record *again =
        kiln_record_parse(arena, text.data, text.length, "again", &error);
    require(again, error.message);
    require(kiln_record_write(again, &text_again, &error), error.message);
    require(strcmp(text.data, text_again.data) == 0, "a written sidecar differs");
    kiln_text_free(&text);
    kiln_text_free(&text_again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    struct kiln_arena *arena = kiln_arena_create();
    if (text && arena) {
        if (size)
            memcpy(text, data, size);
        text[size] = '\0';
        struct kiln_error error = {0};
        const struct kiln_record *record = kiln_record_parse(arena, text, size, "fuzz", &error);
        fuzz_taken = record != NULL;
        if (record) {
            check_record(record);
            check_round_trip(arena, record);
        } else {
            require(error.code != KILN_OK && *error.message, "an error without a message");
        }
    }
    kiln_arena_destroy(&arena);
    free(text);
    return 0;
}
