/* The parent's side: a child imports into shared memory, and what it left there is checked. */
#include "asset/geometry/mesh.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "asset/geometry/mesh_import.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file_in.h"

#define ALLOWED "OBJ, glTF or GLB"

/* The sanitizers' own tables are larger than any limit. */
#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define UNLIMITED
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define UNLIMITED
#endif

static const float MAX_COORDINATE = 1e6f;

/* ---- the child ------------------------------------------------------------------------------- */

#ifndef UNLIMITED
/* The sixth number of statm: pages of data. */
static rlim_t bytes_in_use(void)
{
    char text[256] = "";
    FILE *file = fopen("/proc/self/statm", "r");
    if (file) {
        if (!fgets(text, sizeof text, file))
            text[0] = '\0';
        fclose(file);
    }
    const char *number = text;
    for (int i = 0; i < 5 && number; i++) {
        number = strchr(number, ' ');
        number = number ? number + 1 : NULL;
    }
    return number ? (rlim_t)strtoul(number, NULL, 10) * (rlim_t)sysconf(_SC_PAGESIZE) : 0;
}
#endif

static void lower(struct rlimit *limits, rlim_t most)
{
    if (most < limits->rlim_cur)
        limits->rlim_cur = most;
}

static void limit_resources(void)
{
    struct rlimit limits;
    if (getrlimit(RLIMIT_CORE, &limits) == 0) {
        lower(&limits, 0);
        setrlimit(RLIMIT_CORE, &limits);
    }
    if (getrlimit(RLIMIT_FSIZE, &limits) == 0) {
        lower(&limits, 0);
        setrlimit(RLIMIT_FSIZE, &limits);
    }
#ifndef UNLIMITED
    if (getrlimit(RLIMIT_DATA, &limits) == 0) {
        lower(&limits, bytes_in_use() + KILN_MAX_MESH_MEMORY);
        setrlimit(RLIMIT_DATA, &limits);
    }
#endif
}

/* Whatever the importer does to this process or prints, nobody else is touched. */
static void run_child(const struct kiln_mesh_request *request, struct kiln_mesh_result *result,
                      pid_t parent)
{
    static const int signals[] = {SIGSEGV, SIGBUS,  SIGFPE,  SIGILL, SIGABRT,
                                  SIGINT,  SIGTERM, SIGPIPE, SIGXCPU};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        signal(signals[i], SIG_DFL);
    int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere >= 0) {
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
    }
    /* An importer that nobody waits for would work on for ever. */
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1);
    limit_resources();
    kiln_mesh_import(request, result);
    result->done = true;
    _exit(0);
}

/* ---- the parent ------------------------------------------------------------------------------ */

enum outcome { ENDED, STOPPED, TOO_SLOW, STUCK };

enum { ATTEMPTS = 3, STUCK_SECONDS = 4 };

/* Scenes import before they have threads, but whoever loads one may have some: a child inherits
 * locks that one of them held, and that nobody in the child will release; it waits and takes no
 * time. */
static bool is_stuck(pid_t child, double start_s)
{
    clockid_t clock;
    struct timespec used = {0};
    return kiln_clock_seconds() - start_s > STUCK_SECONDS &&
           clock_getcpuclockid(child, &clock) == 0 && clock_gettime(clock, &used) == 0 &&
           used.tv_sec == 0 && used.tv_nsec < 200000000;
}

/* Kills a child that does not end in time, or when nobody wants it any more; one that is stuck
 * only if it may be tried again. */
static enum outcome await(pid_t child, const struct kiln_mesh_request *request, bool may_retry)
{
    enum outcome outcome = TOO_SLOW;
    const struct timespec pause = {.tv_nsec = 500000};
    double start_s = kiln_clock_seconds();
    while (kiln_clock_seconds() - start_s < KILN_MAX_MESH_SECONDS) {
        pid_t ended = waitpid(child, NULL, WNOHANG);
        if (ended == child || (ended < 0 && errno != EINTR))
            return ENDED;
        if (request->stop && request->stop(request->user)) {
            outcome = STOPPED;
            break;
        }
        if (may_retry && is_stuck(child, start_s)) {
            outcome = STUCK;
            break;
        }
        nanosleep(&pause, NULL);
    }
    kill(child, SIGKILL);
    while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
        continue;
    return outcome;
}

static bool run(const struct kiln_mesh_request *request, struct kiln_mesh_result *result,
                struct kiln_error *error)
{
    enum outcome outcome = STUCK;
    for (int attempt = 0; outcome == STUCK; attempt++) {
        const pid_t parent = getpid();
        pid_t child = fork();
        if (child == 0)
            run_child(request, result, parent);
        if (child < 0)
            return kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno,
                                        "%s: no process for the importer", request->name);
        outcome = await(child, request, attempt < ATTEMPTS);
        /* What a killed child has written is taken away: the next one counts from 0. */
        if (outcome == STUCK && madvise(result, sizeof *result, MADV_REMOVE) != 0)
            outcome = TOO_SLOW;
    }
    if (outcome == STOPPED)
        return kiln_error_set(error, KILN_INTERRUPTED, "%s: stopped while reading the mesh",
                              request->name);
    if (outcome == TOO_SLOW)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the importer was not done with the mesh after %d s",
                              request->name, KILN_MAX_MESH_SECONDS);
    if (!result->done)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the mesh is broken: the importer fails on it", request->name);
    if (result->ok)
        return true;
    const size_t room = sizeof result->error.message;
    return kiln_error_set(error, result->error.code, "%.*s", (int)room, result->error.message);
}

static bool check_vertex(const float v[6])
{
    float length2 = v[3] * v[3] + v[4] * v[4] + v[5] * v[5];
    for (int c = 0; c < 3; c++) {
        if (!(fabsf(v[c]) <= MAX_COORDINATE))
            return false;
    }
    return fabsf(length2 - 1.0f) < 1e-3f;
}

static bool check(const struct kiln_mesh_request *request, const struct kiln_mesh_result *result,
                  struct kiln_error *error)
{
    bool good = result->vertex_count >= 3 && result->vertex_count <= KILN_MAX_MESH_VERTICES &&
                result->triangle_count >= 1 && result->triangle_count <= KILN_MAX_MESH_TRIANGLES &&
                memchr(result->hash, '\0', sizeof result->hash) == result->hash + 64;
    for (uint32_t i = 0; good && i < result->triangle_count; i++) {
        for (int c = 0; c < 3; c++)
            good = good && result->triangles[i][c] < result->vertex_count;
    }
    if (!good)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the mesh is broken: the importer made nonsense of it",
                              request->name);
    for (uint32_t i = 0; i < result->vertex_count; i++) {
        if (!check_vertex(result->vertices[i]))
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: vertex %u lies at %g %g %g; allowed are numbers within "
                                  "-%g and %g",
                                  request->name, i, (double)result->vertices[i][0],
                                  (double)result->vertices[i][1], (double)result->vertices[i][2],
                                  (double)MAX_COORDINATE, (double)MAX_COORDINATE);
    }
    return true;
}

void kiln_mesh_bound(struct kiln_mesh *mesh)
{
    for (int c = 0; c < 3; c++)
        mesh->min[c] = mesh->max[c] = mesh->vertices[0][c];
    for (uint32_t i = 1; i < mesh->vertex_count; i++) {
        for (int c = 0; c < 3; c++) {
            mesh->min[c] = fminf(mesh->min[c], mesh->vertices[i][c]);
            mesh->max[c] = fmaxf(mesh->max[c], mesh->vertices[i][c]);
        }
    }
}

/* Six times the volume of a tetrahedron between a place and a triangle, positive if that faces
 * away. */
static double volume_below(const struct kiln_mesh *mesh, const uint32_t triangle[3],
                           const float from[3])
{
    double v[3][3];
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++)
            v[k][c] = (double)mesh->vertices[triangle[k]][c] - (double)from[c];
    }
    return v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
           v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
           v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
}

void kiln_mesh_face_outwards(struct kiln_mesh *mesh)
{
    double volume = 0.0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        volume += volume_below(mesh, mesh->triangles[i], mesh->min);
    for (uint32_t i = 0; volume < 0.0 && i < mesh->triangle_count; i++) {
        const uint32_t second = mesh->triangles[i][1];
        mesh->triangles[i][1] = mesh->triangles[i][2];
        mesh->triangles[i][2] = second;
    }
}

static struct kiln_mesh *copy(const struct kiln_mesh_result *result, bool uvs)
{
    struct kiln_mesh *mesh = calloc(1, sizeof *mesh);
    if (!mesh)
        return NULL;
    mesh->vertex_count = result->vertex_count;
    mesh->triangle_count = result->triangle_count;
    mesh->vertices = malloc(mesh->vertex_count * sizeof *mesh->vertices);
    mesh->triangles = malloc(mesh->triangle_count * sizeof *mesh->triangles);
    if (uvs)
        mesh->uvs = malloc(mesh->vertex_count * sizeof *mesh->uvs);
    if (!mesh->vertices || !mesh->triangles || (uvs && !mesh->uvs)) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    if (uvs)
        memcpy(mesh->uvs, result->uvs, mesh->vertex_count * sizeof *mesh->uvs);
    memcpy(mesh->vertices, result->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    memcpy(mesh->triangles, result->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    memcpy(mesh->hash, result->hash, sizeof mesh->hash);
    kiln_mesh_bound(mesh);
    return mesh;
}

/* What a file becomes: one of these. */
struct imported {
    struct kiln_mesh *mesh;
    struct kiln_skin *skin; /* of a moving one */
};

static struct imported import(const struct kiln_mesh_request *request, struct kiln_error *error)
{
    struct imported imported = {NULL, NULL};
    struct kiln_mesh_result *result = mmap(NULL, sizeof *result, PROT_READ | PROT_WRITE,
                                           MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (result == MAP_FAILED) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory while reading the mesh",
                       request->name);
        return imported;
    }
    if (run(request, result, error) && check(request, result, error)) {
        struct kiln_mesh *mesh = copy(result, request->uvs);
        if (!mesh)
            kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory while reading the mesh",
                           request->name);
        else if (request->moving)
            imported.skin = kiln_skin_take(request, result, mesh, error);
        else
            imported.mesh = mesh;
    }
    munmap(result, sizeof *result);
    return imported;
}

/* An OBJ has a line for each vertex and each polygon: too many are found before they take time. */
static bool check_lines(const struct kiln_mesh_request *request, struct kiln_error *error)
{
    const char *line = request->bytes, *end = line + request->size;
    size_t vertices = 0, faces = 0;
    while (line && end - line >= 2) {
        vertices += line[0] == 'v' && line[1] == ' ';
        faces += line[0] == 'f' && line[1] == ' ';
        line = memchr(line, '\n', (size_t)(end - line));
        line = line ? line + 1 : NULL;
    }
    if (vertices <= KILN_MAX_MESH_VERTICES && faces <= KILN_MAX_MESH_TRIANGLES)
        return true;
    return kiln_error_set(
        error, KILN_INVALID_INPUT,
        "%s: the mesh has %zu vertices and %zu faces; allowed are %d vertices and "
        "%d triangles",
        request->name, vertices, faces, KILN_MAX_MESH_VERTICES, KILN_MAX_MESH_TRIANGLES);
}

/* The importer goes by the name's end; the contents must at least begin as that says. */
static bool find_extension(struct kiln_mesh_request *request, struct kiln_error *error)
{
    static const char *const extensions[] = {".obj", ".gltf", ".glb"};
    const char *dot = strrchr(request->name, '.');
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++) {
        if (strcasecmp(dot, extensions[i]) == 0)
            request->extension = extensions[i];
    }
    if (!request->extension)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: not a mesh by its name; allowed are " ALLOWED
                              " files (.obj, .gltf, .glb)",
                              request->name);
    const unsigned char *bytes = request->bytes;
    if (request->size == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the mesh file is empty",
                              request->name);
    bool good = true;
    size_t start = 0;
    if (strcmp(request->extension, ".glb") == 0) {
        good = request->size >= 20 && memcmp(bytes, "glTF", 4) == 0;
    } else if (strcmp(request->extension, ".gltf") == 0) {
        while (start < request->size && strchr(" \t\r\n", bytes[start]))
            start++;
        good = start < request->size && bytes[start] == '{';
    } else {
        good = !memchr(bytes, '\0', request->size);
        if (good)
            return check_lines(request, error);
    }
    return good ||
           kiln_error_set(error, KILN_INVALID_INPUT, "%s: by its contents, this is no .%s file",
                          request->name, request->extension + 1);
}

static struct imported parse(struct kiln_mesh_request *request, struct kiln_error *error)
{
    const struct imported nothing = {NULL, NULL};
    if (request->size > KILN_MAX_MESH_BYTES) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the mesh file has %zu bytes; allowed are at most %d", request->name,
                       request->size, KILN_MAX_MESH_BYTES);
        return nothing;
    }
    return find_extension(request, error) ? import(request, error) : nothing;
}

static struct imported load(struct kiln_mesh_request *request, struct kiln_error *error)
{
    struct imported imported = {NULL, NULL};
    const char *path = request->name;
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path)) : strdup(".");
    unsigned char *bytes =
        kiln_file_read(path, "mesh", ALLOWED, KILN_MAX_MESH_BYTES, &request->size, error);
    request->folder = folder;
    request->bytes = bytes;
    if (!folder)
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory while reading", path);
    else if (bytes && find_extension(request, error))
        imported = import(request, error);
    free(bytes);
    free(folder);
    return imported;
}

struct kiln_mesh *kiln_mesh_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error)
{
    struct kiln_mesh_request request = {.name = name, .bytes = bytes, .size = size};
    return parse(&request, error).mesh;
}

struct kiln_mesh *kiln_mesh_load(const char *path, const char *root, bool (*stop)(void *user),
                                 void *user, struct kiln_error *error)
{
    struct kiln_mesh_request request = {.name = path, .root = root, .stop = stop, .user = user};
    return load(&request, error).mesh;
}

struct kiln_mesh *kiln_mesh_load_unwrapped(const char *path, const char *root,
                                           bool (*stop)(void *user), void *user,
                                           struct kiln_error *error)
{
    struct kiln_mesh_request request = {
        .name = path, .uvs = true, .root = root, .stop = stop, .user = user};
    return load(&request, error).mesh;
}

struct kiln_skin *kiln_skin_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error)
{
    struct kiln_mesh_request request = {.name = name, .moving = true, .bytes = bytes, .size = size};
    return parse(&request, error).skin;
}

struct kiln_skin *kiln_skin_load(const char *path, const char *root, bool (*stop)(void *user),
                                 void *user, struct kiln_error *error)
{
    struct kiln_mesh_request request = {
        .name = path, .moving = true, .root = root, .stop = stop, .user = user};
    struct imported imported = load(&request, error);
    kiln_mesh_destroy(&imported.mesh); /* a skin has its own */
    return imported.skin;
}

static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = calloc(count, size);
    return copy ? memcpy(copy, from, count * size) : NULL;
}

struct kiln_mesh *kiln_mesh_copy(const struct kiln_mesh *mesh)
{
    struct kiln_mesh *other = copy_of(mesh, 1, sizeof *mesh);
    if (!other)
        return NULL;
    other->vertices = copy_of(mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    other->triangles = copy_of(mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
    other->uvs = mesh->uvs ? copy_of(mesh->uvs, mesh->vertex_count, sizeof *mesh->uvs) : NULL;
    if (!other->vertices || !other->triangles || (mesh->uvs && !other->uvs))
        kiln_mesh_destroy(&other);
    return other;
}

void kiln_mesh_destroy(struct kiln_mesh **mesh)
{
    if (!*mesh)
        return;
    free((*mesh)->vertices);
    free((*mesh)->triangles);
    free((*mesh)->uvs);
    free(*mesh);
    *mesh = NULL;
}
