/* Renders frames of a test's scene into a folder, and hashes them. */
#ifndef KILN_SUITE_RENDERING_H
#define KILN_SUITE_RENDERING_H

#include "suite/golden.h"

/* Chooses the frames that a test judges: those that it names, or else the middle and the last of
 * the scene's frames, which go into `default_frames`. Returns their count; *numbers points to them,
 * ascending. */
size_t kiln_test_frames(const struct kiln_test *test, uint32_t scene_frames,
                        uint32_t default_frames[2], const uint32_t **numbers);

struct kiln_rendering_params {
    const struct kiln_test *test;
    const char *device;            /* as in kiln_device_params; NULL: KILN_DEVICE_CPU, or the */
                                   /* default device with GL if a technique needs GL */
    const char *const *techniques; /* "stage=name"; they override all others */
    size_t technique_count;
    uint32_t threads;
    const char *folder;   /* for pictures; it must exist */
    const char *name_tag; /* goes into their names: frame_0024TAG.png */
    bool (*stop)(void *user);
    void *user;
    struct kiln_log log;
};

struct kiln_rendered_frame {
    uint32_t number;
    bool drawn;
    char state[17];
    char pixels[65]; /* SHA-256 of the decoded picture */
    char path[KILN_PATH_SIZE];
};

/* The results of a rendering. After an error, the members that were filled before it stay; the
 * others are zero. */
struct kiln_rendering {
    bool no_device; /* there is no device with the requested name */
    struct kiln_device_info device;
    char device_name[KILN_DEVICE_NAME_SIZE];
    struct kiln_scene_info scene;
    uint32_t seed;
    const char *scene_text;    /* as kiln_scene_print writes it */
    const char *scene_origins; /* as kiln_scene_print_origins does */
    char techniques[256];
    size_t frame_count;
    struct kiln_rendered_frame *frames; /* ascending */
};

/* Loads the scene, opens the device, renders and hashes; all texts lie in the arena. The test's
 * techniques override those that every test pins, and params->techniques override both. Returns
 * false with the error of the step that failed, KILN_INVALID_INPUT for a frame that the scene does
 * not have, KILN_FRAME_FAILED for a frame that was not drawn. */
bool kiln_rendering_make(struct kiln_arena *arena, const struct kiln_rendering_params *params,
                         struct kiln_rendering *rendering, struct kiln_error *error);

#endif
