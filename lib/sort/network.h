/* A kiln_network is the part that all sorting networks share: it lists the living particles as
 * pairs (key, index in the list), pads the pairs to a power of two, and writes the list in the
 * order of the sorted pairs. */
#ifndef KILN_SORT_NETWORK_H
#define KILN_SORT_NETWORK_H

#include "sort/alive.h"

/* Sorts `padded` pairs, a power of two, in the buffer that is bound to SORT_BIND_PAIRS. The
 * function may replace the buffer's GL name (pairs->gl). */
typedef bool kiln_network_sort(void *context, struct kiln_buffer *pairs, uint32_t padded,
                               struct kiln_error *error);

struct kiln_network {
    struct kiln_device *device;
    struct kiln_alive alive;
    GLuint pad_program, take_program;
    struct kiln_buffer pairs, list;
    kiln_network_sort *sort;
    void *context;
};

/* kiln_network_finish frees all resources, also after a failure. */
bool kiln_network_init(struct kiln_network *network, struct kiln_device *device,
                       kiln_network_sort *sort, void *context, struct kiln_error *error);
void kiln_network_finish(struct kiln_network *network);

/* Does the same as kiln_sort_run. */
bool kiln_network_run(struct kiln_network *network, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_buffer *entries,
                      uint32_t *count, struct kiln_error *error);

/* Returns the number of pairs that a buffer needs room for to sort `count` pairs: the next power of
 * two. */
uint32_t kiln_network_padded(uint32_t count);

/* Returns the bytes of a network's buffers for a pool with this number of slots: the padded pairs,
 * the unsorted list and the sorted list. */
uint64_t kiln_network_bytes(uint32_t slots);

/* Writes the `count` words of `list` to entries in the ascending order of `pairs` (key, index in
 * the list), or in descending order if `reverse` is set. The pairs are overwritten. */
bool kiln_network_pairs(struct kiln_network *network, struct kiln_buffer *pairs,
                        struct kiln_buffer *list, uint32_t count, bool reverse,
                        struct kiln_buffer *entries, struct kiln_error *error);

/* Returns the number of invocations of a work group on this device. Such a group sorts
 * NETWORK_ITEMS times as many pairs in shared memory. */
uint32_t kiln_network_group_size(const struct kiln_device *device);

/* Describes a kernel of a network and where its program is stored. */
struct kiln_network_kernel {
    const char *file, *defines;
    GLuint *program;
};

/* Creates the programs. Returns false with an error at the first that fails. */
bool kiln_network_programs(struct kiln_device *device, const struct kiln_network_kernel *kernels,
                           size_t count, struct kiln_error *error);

/* Holds the value of a uniform of a kernel. */
struct kiln_network_uniform {
    GLint location; /* SORT_AT_* of shared/sort_layout.h, or of the kernel's own layout */
    uint32_t value;
};

/* Dispatches a program over `work` items, `group_work` of them a work group, with these uniforms,
 * and sets a barrier for storage buffers. */
void kiln_network_dispatch(struct kiln_device *device, GLuint program,
                           const struct kiln_network_uniform *uniforms, size_t uniform_count,
                           uint32_t work, uint32_t group_work);

#endif
