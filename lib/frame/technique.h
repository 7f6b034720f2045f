/* A kiln_techniques says which technique runs each stage. The choice is a pure function of the
 * device and the flags, never of a timing, so that pixels do not depend on luck. */
#ifndef KILN_FRAME_TECHNIQUE_H
#define KILN_FRAME_TECHNIQUE_H

#include "draw/backdrop/backdrop.h"
#include "draw/sprites/particles.h"
#include "kiln.h"
#include "post/bloom.h"
#include "post/composite.h"
#include "sim/step/simulate.h"
#include "sort/sort.h"

enum { KILN_STAGE_COUNT = 6, KILN_TECHNIQUE_SIZE = 32 };
_Static_assert((int)KILN_STAGE_COUNT <= (int)KILN_MAX_STAGES, "statistics hold all choices");

struct kiln_techniques {
    enum kiln_simulate_technique simulate;
    enum kiln_sort_technique sort;
    uint32_t sort_spread; /* frames that `oddeven` spreads a sort over; 0: one frame has all */
    enum kiln_backdrop_technique backdrop;
    enum kiln_raster_technique raster;
    enum kiln_bloom_technique bloom;
    enum kiln_composite_technique composite;
    struct kiln_technique_choice choices[KILN_STAGE_COUNT]; /* the same as texts */
};

/* Applies "stage=name" texts over the device's defaults, which "stage=auto" asks for; the last text
 * for a stage wins. "sort=oddeven:N" spreads it over N frames. An unknown name is KILN_USAGE, and
 * the message lists the known ones; simulating or sorting on a device that is not exact is
 * KILN_NO_DEVICE. */
bool kiln_techniques_choose(const struct kiln_device_info *device, const char *const *flags,
                            size_t flag_count, struct kiln_techniques *techniques,
                            struct kiln_error *error);

/* Returns the device for pictures that shall be the same everywhere: the wanted one, or else
 * KILN_DEVICE_CPU where these techniques allow it, or else the default one with GL. */
struct kiln_device_params kiln_techniques_device(const char *wanted, const char *const *flags,
                                                 size_t flag_count);

/* Holds one technique for each stage that has several, as "stage=name". */
struct kiln_technique_list {
    char flags[KILN_STAGE_COUNT][KILN_TECHNIQUE_SIZE];
};

/* Writes the index-th of all combinations; returns false beyond the last. The first takes the
 * technique `cpu` where a stage has it and the first of its table elsewhere, which makes the same
 * picture on every machine. kiln_techniques_choose tells whether a device allows a combination. */
bool kiln_techniques_combination(size_t index, struct kiln_technique_list *list);

/* Describe a stage below KILN_STAGE_COUNT, to compare its techniques: its name ("sort"), the pass
 * that shows what a technique takes, and its techniques in the order of the table. */
enum { KILN_MAX_TECHNIQUES = 16 };
const char *kiln_stage_name(size_t stage);
enum kiln_pass kiln_stage_pass(size_t stage);
size_t kiln_stage_techniques(size_t stage, const char *names[KILN_MAX_TECHNIQUES]);

/* Writes the technique of a stage, "sort=oddeven:8". */
void kiln_technique_describe(const struct kiln_techniques *techniques, size_t stage, char *out,
                             size_t size);

/* Writes "simulate=cpu sort=cpu backdrop=gl raster=geometry bloom=gl composite=gl". */
void kiln_techniques_describe(const struct kiln_techniques *techniques, char *out, size_t size);

#endif
