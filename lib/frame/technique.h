/* A kiln_techniques holds the technique that runs each stage. The choice is a pure function of the
 * device and the flags. It never depends on a timing, so that the pixels are reproducible. */
#ifndef KILN_FRAME_TECHNIQUE_H
#define KILN_FRAME_TECHNIQUE_H

#include "draw/backdrop/backdrop.h"
#include "draw/sprites/particles.h"
#include "draw/volume/volume.h"
#include "kiln.h"
#include "post/bloom.h"
#include "post/composite.h"
#include "sim/step/simulate.h"
#include "sort/sort.h"

enum { KILN_STAGE_COUNT = 8, KILN_TECHNIQUE_SIZE = 32 };
_Static_assert((int)KILN_STAGE_COUNT <= (int)KILN_MAX_STAGES, "statistics hold all choices");

struct kiln_techniques {
    enum kiln_simulate_technique simulate;
    enum kiln_gas_technique gas;
    enum kiln_sort_technique sort;
    uint32_t sort_number; /* N of "sort=NAME:N"; 0: the technique takes no number */
    enum kiln_backdrop_technique backdrop;
    enum kiln_march_technique march;
    enum kiln_raster_technique raster;
    enum kiln_bloom_technique bloom;
    enum kiln_composite_technique composite;
    struct kiln_technique_choice choices[KILN_STAGE_COUNT]; /* the same as texts */
};

/* Chooses the techniques: the device's defaults, overridden by "stage=name" flags. The last flag
 * for a stage wins. "stage=auto" selects the default. A technique may take a number,
 * "stage=name:N". Fails with KILN_USAGE for an unknown name, and lists the known names, and with
 * KILN_NO_DEVICE if an inexact device would have to simulate or sort. */
bool kiln_techniques_choose(const struct kiln_device_info *device, const char *const *flags,
                            size_t flag_count, struct kiln_techniques *techniques,
                            struct kiln_error *error);

/* Finds the first technique that is there for comparison with papers, "sort=oddeven", and the
 * technique to take for what it cannot do. Returns false if there is none. */
bool kiln_techniques_paper(const struct kiln_techniques *techniques, char name[KILN_TECHNIQUE_SIZE],
                           const char **instead);

/* Returns 0 if no technique keeps a history (particles/history.h), or otherwise a number that tells
 * this history from those of other techniques. Saved states hash it, so it must not change. */
uint32_t kiln_techniques_history(const struct kiln_techniques *techniques);

/* Returns parameters for opening the device of pictures that must be the same everywhere: the
 * wanted device, or else KILN_DEVICE_CPU if the techniques in `flags` run without GL, or else the
 * default device with GL. */
struct kiln_device_params kiln_techniques_device(const char *wanted, const char *const *flags,
                                                 size_t flag_count);

/* Holds one technique for each stage that has several, as "stage=name". */
struct kiln_technique_list {
    char flags[KILN_STAGE_COUNT][KILN_TECHNIQUE_SIZE];
};

/* Writes combination number `index` of all techniques, from 0; returns false beyond the last. The
 * first combination takes for each stage `cpu`, or the first technique of its table if it has no
 * `cpu`, and so makes the same picture on every machine. kiln_techniques_choose checks whether a
 * device allows a combination. */
bool kiln_techniques_combination(size_t index, struct kiln_technique_list *list);

/* Describe stage number `stage`, below KILN_STAGE_COUNT, for comparisons of its techniques: its
 * name ("sort"), the pass whose time shows what a technique costs, and its techniques in the order
 * of the table. */
enum { KILN_MAX_TECHNIQUES = 16 };
const char *kiln_stage_name(size_t stage);
enum kiln_pass kiln_stage_pass(size_t stage);
size_t kiln_stage_techniques(size_t stage, const char *names[KILN_MAX_TECHNIQUES]);

/* Writes the technique of a stage, for example "sort=oddeven:8". */
void kiln_technique_describe(const struct kiln_techniques *techniques, size_t stage, char *out,
                             size_t size);

/* Writes the techniques of all stages, for example "simulate=cpu gas=cpu sort=cpu
 * backdrop=gl raster=geometry bloom=gl composite=gl". */
void kiln_techniques_describe(const struct kiln_techniques *techniques, char *out, size_t size);

#endif
