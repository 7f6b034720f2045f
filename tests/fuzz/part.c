/* Fuzzes kiln_parts_join, which joins part files, each with some frames of a clip, into the clip.
 * Any bytes in a part file must give a clip or an error, never a crash. If this fails, a damaged
 * part file can crash `kiln join`. The target first corrects the checksum of each input, since a
 * file with a wrong checksum is refused before anything else is read.
 */
#include "output/part.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/ffmpeg.h"
#include "fuzz.h"

/* Frame range of the clip in the corpus: two seconds at 4 frames a second, which make one part. */
static const struct kiln_frame_range clip = {0, 7};

static struct kiln_output_params params_of(const char *path, const char *parts)
{
    static const char scene[] = "00";
    struct kiln_error error = {0};
    const struct kiln_output_params params = {.path = path,
                                              .width = 16,
                                              .height = 16,
                                              .fps_num = 4,
                                              .fps_den = 1,
                                              .ranges = &clip,
                                              .range_count = 1,
                                              .clip = &clip,
                                              .clip_count = 1,
                                              .parts = parts,
                                              .threads = 1,
                                              .overwrite = true,
                                              .png_bits = 8,
                                              .exr_bits = 16,
                                              .quality = 80,
                                              .scene_hash = scene};
    return kiln_output_complete(&params, &error);
}

/* Joins a clip from the only part file in the folder. kind: the first byte of the input; modulo 3,
 * it chooses the format of the clip. */
static void join(const char *folder, uint8_t kind)
{
    static const char *const suffixes[] = {"mp4", "webm", "gif"};
    char path[64];
    struct kiln_error error = {0};
    snprintf(path, sizeof path, "%s/c.%s", folder, suffixes[kind % 3]);
    const struct kiln_output_params params = params_of(path, folder);
    fuzz_taken = params.format && kiln_parts_join(&params, &error);
    if (params.format && !fuzz_taken)
        require(error.code != KILN_OK && *error.message, "an error without a message");
    unlink(path);
}

/* Overwrites the clip's hash and the versions of kiln and FFmpeg in the head of the part file,
 * bytes + 1, with the correct ones. With others, the file would be refused before its frames are
 * read. */
static void repair(uint8_t *bytes, size_t length)
{
    enum { CLIP_AT = 12 + 5 * 4, MADE_BY_AT = CLIP_AT + 65, END_AT = MADE_BY_AT + 128 };
    char hash[65], made_by[128] = "";
    static const char *const suffixes[] = {"c.mp4", "c.webm", "c.gif"};
    const struct kiln_output_params params = params_of(suffixes[bytes[0] % 3], NULL);
    if (length < 1 + END_AT || !params.format || !kiln_clip_hash(&params, hash))
        return;
    kiln_part_made_by(made_by);
    memcpy(bytes + 1 + CLIP_AT, hash, sizeof hash);
    memcpy(bytes + 1 + MADE_BY_AT, made_by, sizeof made_by);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/kiln-fuzz-XXXXXX", path[64];
    /* kiln_parts_join relies on its caller to open FFmpeg's libraries. */
    require(kiln_ffmpeg_open(KILN_FFMPEG_CLIPS, NULL), "FFmpeg is missing");
    uint8_t *copy = size < 5 ? NULL : malloc(size);
    if (!copy || !mkdtemp(folder)) {
        free(copy);
        return 0;
    }
    memcpy(copy, data, size);
    repair(copy, size);
    snprintf(path, sizeof path, "%s/00000.part", folder);
    FILE *file = fopen(path, "wb");
    if (file) {
        const size_t length = size - 5; /* bytes, without the first one and the checksum */
        const uint32_t crc = (uint32_t)crc32_z(0, copy + 1, length);
        const uint8_t sum[] = {(uint8_t)crc, (uint8_t)(crc >> 8), (uint8_t)(crc >> 16),
                               (uint8_t)(crc >> 24)};
        bool written = fwrite(copy + 1, 1, length, file) == length;
        written = fwrite(sum, 1, sizeof sum, file) == sizeof sum && written;
        written = fclose(file) == 0 && written;
        if (written)
            join(folder, copy[0]);
        unlink(path);
    }
    rmdir(folder);
    free(copy);
    return 0;
}
