/* A kiln_network is the part that all sorting networks share: it lists the living as pairs (key,
 * place in their list), pads the pairs to a power of two, and writes the list in the order of the
 * sorted pairs. */
#ifndef KILN_SORT_NETWORK_H
#define KILN_SORT_NETWORK_H

#include "sort/alive.h"

/* Sorts the pairs, which are bound; padded: a power of two. It may swap the buffer's GL side. */
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

/* kiln_network_finish frees what there is, also when this fails. */
bool kiln_network_init(struct kiln_network *network, struct kiln_device *device,
                       kiln_network_sort *sort, void *context, struct kiln_error *error);
void kiln_network_finish(struct kiln_network *network);

/* Like kiln_sort_run. */
bool kiln_network_run(struct kiln_network *network, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_buffer *entries,
                      uint32_t *count, struct kiln_error *error);

/* How many pairs a buffer must have room for to sort `count`: the next power of two. */
uint32_t kiln_network_padded(uint32_t count);

/* Writes the words of a list of `count` to entries, ordered by pairs: (key, place in the list),
 * ascending, or descending in `reverse`. The pairs are lost. */
bool kiln_network_pairs(struct kiln_network *network, struct kiln_buffer *pairs,
                        struct kiln_buffer *list, uint32_t count, bool reverse,
                        struct kiln_buffer *entries, struct kiln_error *error);

/* Returns the invocations of a work group in kernels that are made from now on; such a group sorts
 * NETWORK_ITEMS times as many pairs in shared memory. */
uint32_t kiln_network_group_size(const struct kiln_device *device);

/* Describes a kernel of a network. */
struct kiln_network_kernel {
    const char *file, *defines;
    GLuint *program;
};

/* Creates the programs; false with an error at the first that fails. */
bool kiln_network_programs(struct kiln_device *device, const struct kiln_network_kernel *kernels,
                           size_t count, struct kiln_error *error);

/* Dispatches a kernel over `work` items, `group_work` of them a work group, with uniforms at the
 * locations from 0. */
void kiln_network_dispatch(struct kiln_device *device, GLuint program, const uint32_t *uniforms,
                           GLint uniform_count, uint32_t work, uint32_t group_work);

#endif
