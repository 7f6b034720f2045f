/* Stands in for kiln-decode, the separate process that decodes strangers' files, in the fuzz target
 * `answers`. The program tells kiln that it is ready, waits for a request, and answers any request
 * with the bytes of the file that the environment variable KILN_FEED names. */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/loader/protocol.h"

static void send_bytes(const char *bytes, size_t size)
{
    while (size > 0) {
        const ssize_t sent = write(KILN_DECODE_SOCKET, bytes, size);
        if (sent <= 0)
            _exit(0);
        bytes += sent;
        size -= (size_t)sent;
    }
}

int main(void)
{
    const struct kiln_decode_answer ready = {.what = KILN_DECODE_READY, .text = KILN_VERSION};
    static char block[1 << 16];
    struct kiln_decode_request request;
    const char *path = getenv("KILN_FEED");
    const int file = path ? open(path, O_RDONLY) : -1;
    send_bytes((const char *)&ready, sizeof ready);
    if (read(KILN_DECODE_SOCKET, &request, sizeof request) <= 0)
        return 1;
    for (ssize_t got; (got = read(file, block, sizeof block)) > 0;)
        send_bytes(block, (size_t)got);
    return 0;
}
