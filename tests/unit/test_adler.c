/* kiln_adler32 gives what zlib gives, for sizes around those of a group of lanes and of a block,
 * with bytes that make the largest sums. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <zlib.h>

#include "output/adler.h"
#include "support/cmocka.h"

enum {
    SMALL = 200,         /* all sizes up to this are tried */
    LARGEST = 32 * 8200, /* two blocks, and some */
    STEP = 3989
};

static void check_size(const uint8_t *bytes, size_t size)
{
    const uint32_t right = (uint32_t)adler32(1, bytes, (uInt)size);
    const uint32_t found = kiln_adler32(bytes, size);
    if (found != right)
        fail_msg("%zu bytes: %08x, zlib has %08x", size, found, right);
}

static void check_bytes(const uint8_t *bytes)
{
    for (size_t size = 0; size <= SMALL; size++)
        check_size(bytes + size % 3, size);
    for (size_t size = SMALL; size <= LARGEST; size += STEP)
        check_size(bytes, size);
    check_size(bytes, LARGEST);
}

static void sums_are_those_of_zlib(void **state)
{
    (void)state;
    uint8_t *bytes = malloc(LARGEST);
    assert_non_null(bytes);
    for (size_t i = 0; i < LARGEST; i++)
        bytes[i] = 255;
    check_bytes(bytes);
    for (size_t i = 0; i < LARGEST; i++)
        bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    check_bytes(bytes);
    free(bytes);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {cmocka_unit_test(sums_are_those_of_zlib)};
    return cmocka_run_group_tests_name("adler", tests, NULL, NULL);
}
