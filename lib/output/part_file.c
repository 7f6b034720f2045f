/* Writes and reads the file of one part of a clip. It is a line of text, the head, then words and
 * bytes, then the CRC-32 of all of them. Words are little-endian. */
#include "output/part_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "base/error.h"
#include "base/ffmpeg.h"
#include "base/file_in.h"
#include "base/hash.h"
#include "base/text.h"
#include "output/formats.h"

#define MAGIC "kiln part 1\n"

enum { CRC_BYTES = 4 };

bool kiln_clip_hash(const struct kiln_output_params *params, char hash[65])
{
    struct kiln_text text = {0};
    const struct kiln_flipbook *flipbook = &params->flipbook;
    kiln_text_add(&text, "%s %s %u %ux%u %u/%u %d %u %u %u\n", params->format->suffix,
                  params->scene_hash, params->seed, params->width, params->height, params->fps_num,
                  params->fps_den, params->alpha, params->png_bits, params->exr_bits,
                  params->quality);
    kiln_text_add(&text, "%ux%u %u %d %u\n", flipbook->columns, flipbook->rows, flipbook->padding,
                  flipbook->premultiplied, kiln_flipbook_motion_number(flipbook));
    if (flipbook->fade > 0)
        kiln_text_add(&text, "fade %u\n", flipbook->fade);
    for (size_t i = 0; i < params->clip_count; i++)
        kiln_text_add(&text, "%u-%u\n", params->clip[i].first, params->clip[i].last);
    const bool ok = !text.failed;
    if (ok)
        kiln_hash_sha256(text.data, text.length, hash);
    kiln_text_free(&text);
    return ok;
}

void kiln_part_made_by(char text[128])
{
    const bool is_open = kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, NULL);
    snprintf(text, 128, "kiln %s, FFmpeg %s", KILN_VERSION,
             is_open ? kiln_ff.av_version_info() : "none");
}

/* ---- writing --------------------------------------------------------------------------------- */

void kiln_part_add(struct kiln_part_out *out, const void *bytes, size_t size)
{
    if (size == 0) /* for no bytes at NULL, zlib would return the start of a new sum */
        return;
    out->crc = (uint32_t)crc32_z(out->crc, bytes, size);
    kiln_temporary_write(out->file, bytes, size);
}

void kiln_part_add_word(struct kiln_part_out *out, uint32_t word)
{
    const uint8_t bytes[] = {(uint8_t)word, (uint8_t)(word >> 8), (uint8_t)(word >> 16),
                             (uint8_t)(word >> 24)};
    kiln_part_add(out, bytes, sizeof bytes);
}

void kiln_part_begin(struct kiln_part_out *out, struct kiln_temporary *file,
                     const struct kiln_part_head *head)
{
    *out = (struct kiln_part_out){.file = file};
    kiln_part_add(out, MAGIC, strlen(MAGIC));
    const uint32_t words[] = {head->part, head->parts, head->first, head->frames, head->packets};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        kiln_part_add_word(out, words[i]);
    kiln_part_add(out, head->clip, sizeof head->clip);
    kiln_part_add(out, head->made_by, sizeof head->made_by);
}

void kiln_part_end(struct kiln_part_out *out)
{
    kiln_part_add_word(out, out->crc);
}

/* ---- reading --------------------------------------------------------------------------------- */

bool kiln_part_refuse(const struct kiln_part_in *in, const char *reason, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_INVALID_INPUT, "%s: %s", in->path, reason);
}

bool kiln_part_read(struct kiln_part_in *in, void *bytes, size_t size, struct kiln_error *error)
{
    if (size > in->left)
        return kiln_part_refuse(in, "the part of a clip ends too soon", error);
    in->left -= size;
    return fread(bytes, 1, size, in->file) == size ||
           kiln_error_set_errno(error, KILN_IO, ferror(in->file) ? errno : EIO, "%s", in->path);
}

bool kiln_part_read_word(struct kiln_part_in *in, uint32_t *word, struct kiln_error *error)
{
    uint8_t bytes[4];
    if (!kiln_part_read(in, bytes, sizeof bytes, error))
        return false;
    *word =
        bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    return true;
}

/* Reads all bytes but the last four, and compares their checksum with these. */
static bool check_sum(struct kiln_part_in *in, struct kiln_error *error)
{
    uint8_t block[1 << 14];
    uint32_t crc = 0, written = 0;
    if (fseek(in->file, 0, SEEK_END) != 0)
        return kiln_error_set_errno(error, KILN_IO, errno, "%s", in->path);
    const long size = ftell(in->file);
    rewind(in->file);
    if (size < CRC_BYTES)
        return kiln_part_refuse(in, "the file is not a part of a clip", error);
    in->left = (uint64_t)size - CRC_BYTES;
    while (in->left > 0) {
        const size_t count = in->left < sizeof block ? (size_t)in->left : sizeof block;
        if (!kiln_part_read(in, block, count, error))
            return false;
        crc = (uint32_t)crc32_z(crc, block, count);
    }
    in->left = CRC_BYTES;
    if (!kiln_part_read_word(in, &written, error))
        return false;
    rewind(in->file);
    in->left = (uint64_t)size - CRC_BYTES;
    return crc == written || kiln_part_refuse(in, "the part of a clip is damaged", error);
}

static bool read_head(struct kiln_part_in *in, struct kiln_error *error)
{
    char magic[sizeof MAGIC - 1];
    struct kiln_part_head *head = &in->head;
    uint32_t packets = 0;
    uint32_t *const words[] = {&head->part, &head->parts, &head->first, &head->frames, &packets};
    if (in->left < sizeof magic)
        return kiln_part_refuse(in, "the file is not a part of a clip", error);
    if (!kiln_part_read(in, magic, sizeof magic, error))
        return false;
    if (memcmp(magic, MAGIC, sizeof magic) != 0)
        return kiln_part_refuse(in, "the file is not a part of a clip that this kiln reads", error);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (!kiln_part_read_word(in, words[i], error))
            return false;
    }
    head->packets = packets != 0;
    return kiln_part_read(in, head->clip, sizeof head->clip, error) &&
           kiln_part_read(in, head->made_by, sizeof head->made_by, error) &&
           ((head->clip[sizeof head->clip - 1] == '\0' &&
             head->made_by[sizeof head->made_by - 1] == '\0') ||
            kiln_part_refuse(in, "the part of a clip is damaged", error));
}

bool kiln_part_open(struct kiln_part_in *in, const char *path, struct kiln_error *error)
{
    size_t size;
    const int file = kiln_file_open(path, "part of a clip", "kiln part", &size, error);
    if (file < 0)
        return false;
    *in = (struct kiln_part_in){.path = path, .file = fdopen(file, "rb")};
    if (!in->file) {
        close(file);
        return kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "%s", path);
    }
    if (check_sum(in, error) && read_head(in, error))
        return true;
    kiln_part_close(in);
    return false;
}

void kiln_part_close(struct kiln_part_in *in)
{
    if (in->file)
        fclose(in->file);
    in->file = NULL;
}
