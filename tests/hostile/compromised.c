/* Stands in for a kiln-decode that a malicious file has taken over. It confines itself as the real
 * one does. Then, instead of decoding, it misbehaves in the way that the environment variable
 * KILN_COMPROMISED names. "attempts" tries to escape from the confinement and reports which
 * attempts worked. "sound" sends a correct mesh. All other ways send wrong answers or none, which
 * kiln must notice. */
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <math.h>
#include <netinet/in.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include "decode.h"

static pid_t parent;

/* ---- escapes: each function returns whether one of its system calls worked ------------------- */

static bool open_file(void)
{
    return open("/etc/passwd", O_RDONLY) >= 0 || open("/proc/self/maps", O_RDONLY) >= 0 ||
           syscall(SYS_open, "/etc/passwd", O_RDONLY) >= 0;
}

static bool open_parent(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/mem", (int)parent);
    return open(path, O_RDWR) >= 0;
}

static bool write_file(void)
{
    return open("/tmp/kiln-compromised", O_WRONLY | O_CREAT, 0600) >= 0 ||
           mkdir("/tmp/kiln-compromised", 0700) == 0 || unlink("/tmp/kiln-secret") == 0 ||
           rename("/tmp/kiln-secret", "/tmp/kiln-compromised") == 0 || chmod("/tmp", 0777) == 0;
}

/* Writes to the file that kiln sent, which must be open only for reading. */
static bool write_to_asset(void)
{
    for (int file = 4; file < 16; file++) {
        if (pwrite(file, "x", 1, 0) == 1 || ftruncate(file, 0) == 0)
            return true;
    }
    return false;
}

static bool connect_somewhere(void)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(80)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int file = socket(AF_INET, SOCK_STREAM, 0);
    int pair[2];
    return file >= 0 || socket(AF_UNIX, SOCK_DGRAM, 0) >= 0 ||
           socketpair(AF_UNIX, SOCK_STREAM, 0, pair) == 0 ||
           connect(KILN_DECODE_SOCKET, (const void *)&address, sizeof address) == 0;
}

static bool start_process(void)
{
    const pid_t child = fork();
    if (child == 0)
        _exit(0);
    return child > 0 || syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0) > 0 || syscall(SYS_vfork) > 0;
}

static bool execute(void)
{
    char *const arguments[] = {(char *)"true", NULL};
    execve("/bin/true", arguments, arguments);
    syscall(SYS_execveat, AT_FDCWD, "/bin/true", arguments, arguments, 0);
    return false; /* after a successful execve, this process could not answer */
}

static bool signal_parent(void)
{
    return kill(parent, 0) == 0 || kill(parent, SIGSTOP) == 0 || kill(1, 0) == 0 ||
           syscall(SYS_tgkill, parent, parent, 0) == 0 || syscall(SYS_tkill, parent, 0) == 0;
}

static bool trace_parent(void)
{
    char byte;
    struct iovec here = {&byte, 1}, there = {(void *)0x400000, 1};
    return ptrace(PTRACE_ATTACH, parent, NULL, NULL) == 0 ||
           process_vm_readv(parent, &here, 1, &there, 1, 0) > 0 ||
           syscall(SYS_pidfd_open, parent, 0) >= 0;
}

static bool make_code(void)
{
    void *memory = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return mmap(NULL, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                0) != MAP_FAILED ||
           mprotect(memory, 4096, PROT_READ | PROT_EXEC) == 0;
}

static bool take_more(void)
{
    const struct rlimit much = {RLIM_INFINITY, RLIM_INFINITY};
    return setrlimit(RLIMIT_CPU, &much) == 0 || prctl(PR_SET_DUMPABLE, 1, 0, 0, 0) == 0 ||
           syscall(SYS_memfd_create, "x", 0) >= 0 || syscall(SYS_unshare, 0x10000000) == 0 ||
           mmap(NULL, (size_t)8 << 30, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                0) != MAP_FAILED ||
           mmap(NULL, (size_t)1 << 20, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0) !=
               MAP_FAILED ||
           syscall(SYS_io_uring_setup, 1, NULL) != -1 || syscall(SYS_bpf, 0, NULL, 0) != -1;
}

/* Sends by calls that carry more than bytes: descriptors, addresses, urgent data. */
static bool send_more(void)
{
    union {
        struct cmsghdr header;
        char room[CMSG_SPACE(sizeof(int))];
    } control = {.header = {.cmsg_len = CMSG_LEN(sizeof(int)),
                            .cmsg_level = SOL_SOCKET,
                            .cmsg_type = SCM_RIGHTS}};
    struct iovec part = {(char *)"", 1};
    struct mmsghdr message = {.msg_hdr = {.msg_iov = &part,
                                          .msg_iovlen = 1,
                                          .msg_control = control.room,
                                          .msg_controllen = sizeof control.room}};
    memcpy(CMSG_DATA(&control.header), &(int){KILN_DECODE_SOCKET}, sizeof(int));
    return sendmsg(KILN_DECODE_SOCKET, &message.msg_hdr, 0) >= 0 ||
           sendmmsg(KILN_DECODE_SOCKET, &message, 1, 0) >= 0 ||
           send(KILN_DECODE_SOCKET, "x", 1, MSG_OOB) >= 0 ||
           sendto(KILN_DECODE_SOCKET, "", 0, 0, NULL, 0) >= 0 ||
           recv(KILN_DECODE_SOCKET, &(char){0}, 1, MSG_DONTWAIT | MSG_PEEK) >= 0 ||
           errno != ENOSYS || shutdown(KILN_DECODE_SOCKET, SHUT_RD) == 0 ||
           setsockopt(KILN_DECODE_SOCKET, SOL_SOCKET, SO_SNDBUF, &(int){1 << 20}, sizeof(int)) == 0;
}

/* Acts on what a descriptor leads to. */
static bool command_descriptors(void)
{
    return ioctl(KILN_DECODE_SOCKET, FIONBIO, &(int){1}) == 0 ||
           ioctl(0, FIONREAD, &(int){0}) == 0 || errno != ENOSYS ||
           fcntl(KILN_DECODE_SOCKET, F_SETFL, O_NONBLOCK) == 0 ||
           fcntl(KILN_DECODE_SOCKET, F_SETOWN, parent) == 0 || dup(KILN_DECODE_SOCKET) >= 0;
}

static sigjmp_buf before_fault;

static void on_fault(int signal)
{
    (void)signal;
    siglongjmp(before_fault, 1);
}

/* Prepares the process for a fault while it still may. As under `ulimit -s unlimited`, the stack
 * may grow without a limit. */
static void expect_faults(void)
{
    static char stack[1 << 16];
    const struct rlimit much = {RLIM_INFINITY, RLIM_INFINITY};
    const struct sigaction action = {.sa_handler = on_fault, .sa_flags = SA_ONSTACK | SA_NODEFER};
    setrlimit(RLIMIT_STACK, &much);
    sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
    sigaction(SIGSEGV, &action, NULL);
}

/* Takes memory that RLIMIT_DATA does not count: the stack, and tables of pages that are only read.
 */
static bool take_uncounted(void)
{
    char here;
    volatile char *volatile top = &here;
    const ptrdiff_t depth = (ptrdiff_t)64 << 20;
    if (sigsetjmp(before_fault, 0) == 0) {
        top[-depth] = 1;
        return true;
    }
    return mmap(NULL, (size_t)1 << 40, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1,
                0) != MAP_FAILED;
}

static const struct attempt {
    const char *name;
    bool (*try)(void);
} attempts[] = {
    {"open a file", open_file},
    {"open kiln's memory", open_parent},
    {"write a file", write_file},
    {"write to the asset", write_to_asset},
    {"connect", connect_somewhere},
    {"fork", start_process},
    {"exec", execute},
    {"send a signal", signal_parent},
    {"trace kiln", trace_parent},
    {"make code", make_code},
    {"take more", take_more},
    {"send more than bytes", send_more},
    {"command a descriptor", command_descriptors},
    {"take uncounted memory", take_uncounted},
};

static void try_all(char *text, size_t size)
{
    size_t length = (size_t)snprintf(text, size, "worked:");
    for (size_t i = 0; i < sizeof attempts / sizeof *attempts; i++) {
        if (attempts[i].try())
            length += (size_t)snprintf(text + length, size - length, " %s,", attempts[i].name);
    }
    snprintf(text + length, size - length, " and %zu were tried",
             sizeof attempts / sizeof *attempts);
}

/* ---- wrong answers --------------------------------------------------------------------------- */

static void send_bytes(const void *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t sent = write(KILN_DECODE_SOCKET, (const char *)bytes + done, size - done);
        if (sent <= 0)
            _exit(0);
        done += (size_t)sent;
    }
}

static void send_answer(struct kiln_decode_answer answer)
{
    send_bytes(&answer, sizeof answer);
}

static void send_floats(float value)
{
    float pixels[4 * 4 * 4];
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++)
        pixels[i] = value;
    send_answer((struct kiln_decode_answer){
        .what = KILN_DECODE_PIXELS, .width = 4, .height = 4, .channels = 4, .type = 2, .pages = 1});
    send_bytes(pixels, sizeof pixels);
}

static void send_size(uint32_t width, uint32_t height, uint32_t channels, uint32_t type)
{
    send_answer((struct kiln_decode_answer){.what = KILN_DECODE_PIXELS,
                                            .width = width,
                                            .height = height,
                                            .channels = channels,
                                            .type = type,
                                            .pages = 1});
}

static void send_failure(int32_t code, const char *text)
{
    struct kiln_decode_answer answer = {.what = KILN_DECODE_FAILED, .code = code};
    snprintf(answer.text, sizeof answer.text, "%s", text);
    send_answer(answer);
}

static void send_mesh(uint32_t vertices, uint32_t triangles, const float *places,
                      const uint32_t *corners)
{
    send_answer((struct kiln_decode_answer){
        .what = KILN_DECODE_MESH_MADE, .vertices = vertices, .triangles = triangles});
    if (places)
        send_bytes(places, 6 * vertices * sizeof *places);
    if (corners)
        send_bytes(corners, 3 * triangles * sizeof *corners);
}

/* Three vertices, each a position and a normal. */
static const float SOUND[18] = {0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0};
static const uint32_t CORNERS[3] = {0, 2, 1};

/* Sends a correct triangle except for one number of its vertices. */
static void send_triangle(size_t which, float value)
{
    float places[18];
    memcpy(places, SOUND, sizeof places);
    places[which] = value;
    send_mesh(3, 1, places, CORNERS);
}

static void do_attempts(void)
{
    char text[KILN_MESSAGE_SIZE];
    try_all(text, sizeof text);
    send_failure(KILN_INVALID_INPUT, text);
}

/* A text with escape sequences of terminals, a text direction override, a byte that is not UTF-8,
 * and formats of printf. */
static const char ESCAPES[] = {27,         ']',        '0', ';', 'x', 7,   (char)0xe2, (char)0x80,
                               (char)0xae, (char)0xff, '%', 's', '%', 'n', 0};

static void do_escapes(void)
{
    send_failure(KILN_INVALID_INPUT, ESCAPES);
}

/* Sends a picture with such a text as its warning. */
static void do_warning(void)
{
    struct kiln_decode_answer answer = {
        .what = KILN_DECODE_PIXELS, .width = 1, .height = 1, .channels = 3, .srgb = 1, .pages = 7};
    memcpy(answer.text, ESCAPES, sizeof ESCAPES);
    send_answer(answer);
    send_bytes(CORNERS, 4);
}

/* Sends a message without a zero byte at its end. */
static void do_endless_text(void)
{
    struct kiln_decode_answer answer = {.what = KILN_DECODE_FAILED, .code = KILN_INVALID_INPUT};
    memset(answer.text, 'a', sizeof answer.text);
    send_answer(answer);
}

static void send_wish(const char *name)
{
    struct kiln_decode_answer answer = {.what = KILN_DECODE_NEEDS_FILE};
    snprintf(answer.text, sizeof answer.text, "%s", name);
    send_answer(answer);
}

/* Asks for files without end, and reads the answers. */
static void do_wants(void)
{
    struct kiln_decode_file file;
    do
        send_wish("deep.bin");
    while (read(KILN_DECODE_SOCKET, &file, sizeof file) > 0);
}

/* Asks for files without end, and reads no answer, so that the socket fills up. */
static void do_wants_deaf(void)
{
    for (;;)
        send_wish("deep.bin");
}

/* Asks for a file outside of the asset root, and reports whether kiln opened it. */
static void do_wants_secret(void)
{
    struct kiln_decode_file file = {.is_open = 0};
    send_wish("../secret.txt");
    const bool heard = read(KILN_DECODE_SOCKET, &file, sizeof file) > 0;
    send_failure(KILN_INVALID_INPUT, heard && file.is_open ? "it was opened" : "it was not");
}

/* Waits without taking processor time. */
static void wait_ms(long ms)
{
    static uint32_t word;
    const struct timespec time = {ms / 1000, 1000000 * (ms % 1000)};
    syscall(SYS_futex, &word, FUTEX_WAIT, 0, &time, NULL, 0);
}

/* Sends a sound picture so slowly that each wait of kiln's for itself is short. */
static void do_drip(void)
{
    static const char pixels[256 * 256 * 4];
    send_size(256, 256, 4, 0);
    for (size_t i = 0; i < sizeof pixels; i++) {
        send_bytes(pixels + i, 1);
        wait_ms(20);
    }
}

/* Asks for files that are there, for ever, with a pause before each. */
static void do_wants_slowly(void)
{
    struct kiln_decode_file file;
    do {
        wait_ms(100);
        send_wish("a.obj");
    } while (read(KILN_DECODE_SOCKET, &file, sizeof file) > 0);
}

static void do_busy(void)
{
    for (volatile unsigned i = 0;; i++)
        continue;
}

/* Announces a picture and ends without its pixels. */
static void do_short(void)
{
    send_size(64, 64, 4, 0);
    _exit(0);
}

/* Sends a triangle with a corner that is no vertex. */
static void do_beyond(void)
{
    const uint32_t beyond[3] = {0, 2, 0x7fffffff};
    send_mesh(3, 1, SOUND, beyond);
}

#define DO(name, call)                                                                             \
    static void do_##name(void)                                                                    \
    {                                                                                              \
        call;                                                                                      \
    }
/* "overflow" sends a size whose product overflows 32 bits. "largest" sends edges that are allowed,
 * with a product that is not. "far", "no_place" and "no_normal" send a coordinate beyond the
 * limits, one that is not a number, and a normal that is not of unit length. */
DO(huge, send_size(0xffffffffu, 0xffffffffu, 4, 0))
DO(overflow, send_size(0x10000, 0x10001, 4, 2))
DO(largest, send_size(16384, 16384, 4, 2))
DO(nothing, send_size(0, 0, 4, 0))
DO(type, send_size(4, 4, 4, 77))
DO(channels, send_size(4, 4, 9000, 0))
DO(nan, send_floats(NAN))
DO(infinite, send_floats(INFINITY))
DO(silent, pause())
DO(crash, abort())
DO(what, send_answer((struct kiln_decode_answer){.what = 0xdeadbeef}))
DO(other, send_answer((struct kiln_decode_answer){.what = KILN_DECODE_READY}))
DO(no_error, send_failure(KILN_OK, "all is well"))
DO(wrong_code, send_failure(-12345, "?"))
DO(over, send_failure(KILN_OVER_LIMIT, "over"))
DO(vertices, send_mesh(0xfffffff0u, 0xfffffff0u, NULL, NULL))
DO(no_triangles, send_mesh(3, 0, SOUND, NULL))
DO(far, send_triangle(0, 1e30f))
DO(no_place, send_triangle(7, NAN))
DO(no_normal, send_triangle(4, 40))
DO(sound, send_mesh(3, 1, SOUND, CORNERS))

static const struct way {
    const char *name;
    void (*act)(void);
} ways[] = {
    {"attempts", do_attempts},
    {"escapes", do_escapes},
    {"warning", do_warning},
    {"endless-text", do_endless_text},
    {"wants", do_wants},
    {"wants-deaf", do_wants_deaf},
    {"wants-secret", do_wants_secret},
    {"drip", do_drip},
    {"wants-slowly", do_wants_slowly},
    {"busy", do_busy},
    {"short", do_short},
    {"beyond", do_beyond},
    {"huge", do_huge},
    {"overflow", do_overflow},
    {"largest", do_largest},
    {"nothing", do_nothing},
    {"type", do_type},
    {"channels", do_channels},
    {"nan", do_nan},
    {"infinite", do_infinite},
    {"silent", do_silent},
    {"crash", do_crash},
    {"what", do_what},
    {"other", do_other},
    {"no-error", do_no_error},
    {"wrong-code", do_wrong_code},
    {"over", do_over},
    {"vertices", do_vertices},
    {"no-triangles", do_no_triangles},
    {"far", do_far},
    {"no-place", do_no_place},
    {"no-normal", do_no_normal},
    {"sound", do_sound},
};

static void misbehave(const char *how)
{
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        if (strcmp(ways[i].name, how) == 0)
            ways[i].act();
    }
}

/* ---- the process ----------------------------------------------------------------------------- */

int main(int argc, char **argv)
{
    const char *how = getenv("KILN_COMPROMISED");
    struct kiln_error error = {0};
    struct kiln_decode_request request;
    struct kiln_decode_answer ready = {.what = KILN_DECODE_READY};
    parent = getppid();
    strcpy(ready.text, how && strcmp(how, "version") == 0 ? "99" : KILN_VERSION);
    (void)argv;
    expect_faults();
    if (argc != 3 || !how || !decode_confine(KILN_DECODE_PNG, UINT64_MAX, &error))
        return 1;
    send_answer(ready);
    while (read(KILN_DECODE_SOCKET, &request, sizeof request) > 0)
        misbehave(how);
    return 0;
}
