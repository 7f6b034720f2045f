/* Runs a fuzz target without libFuzzer, as the test fuzz.TARGET: `replay MUTATIONS FOLDER...` gives
 * the target every file of the folders, and MUTATIONS mutations of each file. The mutations are the
 * same in every run, so that a failure can be repeated. If this fails, an input crashes one of
 * kiln's readers, or a reader refuses a valid file, which lies in a folder named "good". */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fuzz.h"

/* A build with sanitizers runs a quarter of the mutations, since each takes several times as
 * long. */
#ifdef __SANITIZE_ADDRESS__
enum { MUTATION_DIVISOR = 4 };
#else
enum { MUTATION_DIVISOR = 1 };
#endif

enum { MAX_SIZE = 1 << 20 };

static uint32_t next_random(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 33);
}

/* Pieces of text that mutations insert: syntax and values at which readers of YAML and JSON may
 * fail. */
static const char *const pieces[] = {
    "{",    "}",    "[",          "]",      ": ",  ", ",       "- ",   "\n",    "\"",   "'",
    "&a ",  "*a",   "<<: ",       "!!int ", "? ",  "|",        "#",    "---\n", "keys", "life",
    "none", "auto", "1e39",       "-1",     "0",   ".nan",     "deg",  " s",    "\t",   "\xff",
    "\r\n", "%",    "4294967296", "1e-45",  "1/0", "builtin:", "../",  "*",     ".",    "true",
    "$",    "$$",   "\"= ",       " + ",    "(",   "use: ",    "min(", "$a",    "50 %", "params",
};

static size_t insert(uint8_t *data, size_t size, size_t at, const void *bytes, size_t count)
{
    memmove(data + at + count, data + at, size - at);
    memcpy(data + at, bytes, count);
    return size + count;
}

/* Changes, removes or inserts bytes at one to four random places of an input of `size` bytes. The
 * buffer has room for 256 more bytes. Returns the new size. */
static size_t mutate(uint8_t *data, size_t size, uint64_t *random)
{
    uint32_t changes = 1 + next_random(random) % 4;
    while (changes--) {
        size_t at = size ? next_random(random) % size : 0;
        uint32_t what = next_random(random) % 4;
        if (what == 0 && size) {
            data[at] = (uint8_t)next_random(random);
        } else if (what == 1 && size) {
            size_t length = 1 + next_random(random) % 16;
            length = length < size - at ? length : size - at;
            memmove(data + at, data + at + length, size - at - length);
            size -= length;
        } else if (what == 2) {
            const char *piece = pieces[next_random(random) % (sizeof pieces / sizeof *pieces)];
            size = insert(data, size, at, piece, strlen(piece));
        } else if (size) { /* inserts a copy of some bytes of the input */
            size_t length = 1 + next_random(random) % 64;
            length = length < size - at ? length : size - at;
            uint8_t copy[64];
            memcpy(copy, data + at, length);
            size = insert(data, size, next_random(random) % size, copy, length);
        }
    }
    return size;
}

/* Runs the target on a file and on mutations of it. If `good` is true, the target must accept the
 * file itself. Returns 1 if the file cannot be read or is not accepted, otherwise 0. */
static int replay_file(const char *path, unsigned mutations, bool good)
{
    int failed = 0;
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return 1;
    }
    uint8_t *seed = malloc(MAX_SIZE), *data = malloc(MAX_SIZE + 1024);
    if (seed && data) {
        size_t size = fread(seed, 1, MAX_SIZE, file);
        uint64_t random = size;
        LLVMFuzzerTestOneInput(seed, size);
        if (good && !fuzz_taken) {
            fprintf(stderr, "%s: good, but the target does not take it\n", path);
            failed = 1;
        }
        for (unsigned i = 0; i < mutations; i++) {
            memcpy(data, seed, size);
            LLVMFuzzerTestOneInput(data, mutate(data, size, &random));
        }
    }
    fclose(file);
    free(seed);
    free(data);
    return failed;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int replay_folder(const char *folder, unsigned mutations, unsigned *files)
{
    struct dirent **entries = NULL;
    const size_t length = strlen(folder);
    const bool good = length >= 5 && strcmp(folder + length - 5, "/good") == 0;
    int count = scandir(folder, &entries, NULL, by_name), failed = 0;
    if (count < 0) {
        perror(folder);
        return 1;
    }
    for (int i = 0; i < count; i++) {
        char path[4096];
        struct stat status;
        snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        if (stat(path, &status) == 0 && S_ISREG(status.st_mode)) {
            failed |= replay_file(path, mutations, good);
            ++*files;
        }
        free(entries[i]);
    }
    free(entries);
    return failed;
}

int main(int argc, char **argv)
{
    unsigned mutations = argc > 1 ? (unsigned)strtoul(argv[1], NULL, 10) : 0, files = 0;
    mutations = (mutations + MUTATION_DIVISOR - 1) / MUTATION_DIVISOR;
    int failed = 0;
    for (int i = 2; i < argc; i++)
        failed |= replay_folder(argv[i], mutations, &files);
    printf("%u files, %u mutations of each\n", files, mutations);
    return failed || files == 0;
}
