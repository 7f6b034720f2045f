/* Checks kiln_buffer (lib/gpu/buffer.h), which keeps the same bytes on the host and in a GL buffer:
 * each side sees what was written last, no more bytes are copied than needed, copied bytes are
 * counted, and a lack of memory is an error. If this fails, stages read stale data, or needless
 * copies slow down each step. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "gpu/buffer.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"

enum { COUNT = 1000 };

/* Reads words of a GL buffer by calls of GL, of which the kiln_buffer does not know. */
static void peek(GLuint gl, uint32_t *words, size_t count)
{
    glBindBuffer(GL_COPY_READ_BUFFER, gl);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)(count * sizeof *words), words);
}

/* Writes words to a GL buffer by calls of GL, of which the kiln_buffer does not know. */
static void poke(GLuint gl, const uint32_t *words, size_t count)
{
    glBindBuffer(GL_COPY_READ_BUFFER, gl);
    glBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)(count * sizeof *words), words);
}

static void contents_start_as_zeros(void **state)
{
    struct kiln_error error = {0};
    uint32_t words[COUNT];
    struct kiln_buffer buffer;
    kiln_buffer_init(&buffer, *state, sizeof words, "zeros");
    GLuint gl = kiln_buffer_gl(&buffer, KILN_READ, &error);
    assert_true(gl != 0);
    memset(words, 0xff, sizeof words);
    peek(gl, words, COUNT);
    for (size_t i = 0; i < COUNT; i++)
        assert_int_equal(words[i], 0);
    kiln_buffer_finish(&buffer);

    kiln_buffer_init(&buffer, NULL, sizeof words, "zeros");
    const uint32_t *host = kiln_buffer_host(&buffer, KILN_READ, &error);
    assert_non_null(host);
    assert_int_equal((uintptr_t)host % 64, 0);
    for (size_t i = 0; i < COUNT; i++)
        assert_int_equal(host[i], 0);
    assert_int_equal(kiln_buffer_gl(&buffer, KILN_READ, &error), 0);
    expect_error(&error, KILN_DEVICE_FAILED, "zeros: a host buffer is not in GL");
    kiln_buffer_finish(&buffer);
}

static void each_side_sees_the_last_write(void **state)
{
    struct kiln_error error = {0};
    uint32_t words[COUNT];
    struct kiln_buffer buffer;
    kiln_buffer_init(&buffer, *state, sizeof words, "residency");

    uint32_t *host = kiln_buffer_host(&buffer, KILN_OVERWRITE, &error);
    for (uint32_t i = 0; i < COUNT; i++)
        host[i] = i;
    GLuint gl = kiln_buffer_gl(&buffer, KILN_READ, &error);
    peek(gl, words, COUNT);
    assert_int_equal(words[COUNT - 1], COUNT - 1);
    assert_true(buffer.host_valid && buffer.gl_valid);

    /* After a write in GL, the copy on the host is stale, and the next read on the host fetches the
     * bytes. */
    assert_int_equal(kiln_buffer_gl(&buffer, KILN_READ_WRITE, &error), gl);
    assert_false(buffer.host_valid);
    for (uint32_t i = 0; i < COUNT; i++)
        words[i] = 7 * i;
    poke(gl, words, COUNT);
    assert_ptr_equal(kiln_buffer_host(&buffer, KILN_READ, &error), host);
    assert_int_equal(host[100], 700);
    assert_true(buffer.gl_valid);

    /* After a write on the host, the copy in GL is stale, and the next read in GL sends the bytes
     * there. */
    kiln_buffer_host(&buffer, KILN_READ_WRITE, &error);
    assert_false(buffer.gl_valid);
    host[3] = 333;
    kiln_buffer_gl(&buffer, KILN_READ, &error);
    peek(gl, words, COUNT);
    assert_int_equal(words[3], 333);
    assert_int_equal(words[100], 700);

    words[COUNT - 1] = 99;
    assert_int_equal(kiln_buffer_upload(&buffer, words, &error), gl);
    peek(gl, words, COUNT);
    assert_true(words[COUNT - 1] == 99 && host[COUNT - 1] == 99);
    kiln_buffer_finish(&buffer);
    assert_true(buffer.gl == 0 && buffer.host == NULL);
}

static void nothing_moves_without_need(void **state)
{
    struct kiln_error error = {0};
    const uint32_t in_gl = 5;
    struct kiln_buffer buffer;
    kiln_buffer_init(&buffer, *state, sizeof in_gl, "lazy");
    uint32_t *host = kiln_buffer_host(&buffer, KILN_OVERWRITE, &error);
    *host = 1;
    /* While the copies on both sides are valid, a read on the host fetches nothing. So the host
     * does not see a change that poke made. */
    GLuint gl = kiln_buffer_gl(&buffer, KILN_READ, &error);
    poke(gl, &in_gl, 1);
    kiln_buffer_host(&buffer, KILN_READ, &error);
    assert_int_equal(*host, 1);
    /* A host that will overwrite all bytes does not fetch the bytes that GL wrote. */
    kiln_buffer_gl(&buffer, KILN_READ_WRITE, &error);
    poke(gl, &in_gl, 1);
    kiln_buffer_host(&buffer, KILN_OVERWRITE, &error);
    assert_int_equal(*host, 1);
    /* If GL will overwrite all bytes, the bytes that the host wrote are not sent to GL. */
    kiln_buffer_gl(&buffer, KILN_OVERWRITE, &error);
    uint32_t seen = 0;
    peek(gl, &seen, 1);
    assert_int_equal(seen, 5);
    kiln_buffer_finish(&buffer);
}

static void size_zero_is_allowed(void **state)
{
    struct kiln_error error = {0};
    struct kiln_buffer buffer;
    kiln_buffer_init(&buffer, *state, 0, "empty");
    assert_non_null(kiln_buffer_host(&buffer, KILN_OVERWRITE, &error));
    assert_true(kiln_buffer_gl(&buffer, KILN_READ_WRITE, &error) != 0);
    assert_non_null(kiln_buffer_host(&buffer, KILN_READ, &error));
    kiln_buffer_finish(&buffer);
}

static void bytes_that_move_are_counted(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    struct kiln_buffer buffer;
    const struct kiln_traffic before = device->traffic;
    kiln_buffer_init(&buffer, device, 1000, "counted");
    assert_non_null(kiln_buffer_host(&buffer, KILN_OVERWRITE, &error));
    assert_int_equal(device->traffic.to_device, before.to_device);
    assert_true(kiln_buffer_gl(&buffer, KILN_READ, &error) != 0);
    assert_true(kiln_buffer_gl(&buffer, KILN_READ_WRITE, &error) != 0);
    assert_int_equal(device->traffic.to_device, before.to_device + 1000);
    assert_int_equal(device->traffic.to_host, before.to_host);
    assert_non_null(kiln_buffer_host(&buffer, KILN_READ, &error));
    assert_non_null(kiln_buffer_host(&buffer, KILN_READ, &error));
    assert_int_equal(device->traffic.to_device, before.to_device + 1000);
    assert_int_equal(device->traffic.to_host, before.to_host + 1000);

    /* After kiln_buffer_set_content, the next read in GL copies only that many bytes, 24. After the
     * next write it copies all 1000 again. */
    for (int turn = 0; turn < 2; turn++) {
        assert_non_null(kiln_buffer_host(&buffer, KILN_READ_WRITE, &error));
        if (turn == 0)
            kiln_buffer_set_content(&buffer, 24);
        assert_true(kiln_buffer_gl(&buffer, KILN_READ, &error) != 0);
    }
    assert_int_equal(device->traffic.to_device, before.to_device + 1000 + 24 + 1000);
    kiln_buffer_finish(&buffer);
}

static void too_much_memory_is_an_error(void **state)
{
    struct kiln_device *device = *state;
    const struct kiln_log log = device->log;
    device->log = (struct kiln_log){0};
    static const size_t sizes[] = {SIZE_MAX, SIZE_MAX / 2, (size_t)1 << 50};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct kiln_buffer buffer;
        struct kiln_error error = {0};
        kiln_buffer_init(&buffer, device, sizes[i], "huge");
        assert_int_equal(kiln_buffer_gl(&buffer, KILN_OVERWRITE, &error), 0);
        if (sizes[i] > PTRDIFF_MAX)
            expect_error(&error, KILN_DEVICE_FAILED,
                         "out of memory for %zu bytes of the buffer 'huge' in GL", sizes[i]);
        else /* the driver adds words of its own */
            expect_error_around(
                &error, KILN_DEVICE_FAILED, "",
                "huge, %zu bytes: GL: the device is out of memory (0x0505): ", sizes[i]);
        error = (struct kiln_error){0};
        assert_null(kiln_buffer_host(&buffer, KILN_OVERWRITE, &error));
        expect_error(&error, KILN_DEVICE_FAILED,
                     "out of memory for %zu bytes of the buffer 'huge' on the host", sizes[i]);
        kiln_buffer_finish(&buffer);
    }
    device->log = log;
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(contents_start_as_zeros),     test_on_device(each_side_sees_the_last_write),
        test_on_device(nothing_moves_without_need),  test_on_device(size_zero_is_allowed),
        test_on_device(bytes_that_move_are_counted), test_on_device(too_much_memory_is_an_error),
    };
    return cmocka_run_group_tests_name("buffer", tests, test_device_open, test_device_close);
}
