/* Declares the option types that test files and expect.yaml have and scenes do not, and the option
 * of a mask, which both files have. Values of these types are only read, not printed. */
#ifndef KILN_SUITE_TYPE_H
#define KILN_SUITE_TYPE_H

#include "option/reader.h"
#include "suite/expect.h"

enum {
    KILN_TEST_MAX_MASKS = 64,
    KILN_TEST_MAX_TECHNIQUES = 16,
    KILN_TEST_MAX_FRAME = 999999, /* the last frame that a scene can have */
};

extern const struct kiln_option_type kiln_type_override;  /* key=value */
extern const struct kiln_option_type kiln_type_technique; /* stage=name */
extern const struct kiln_option_type kiln_type_device;    /* as in kiln_device_params */
extern const struct kiln_option_type kiln_type_size;      /* [w, h], or scene */
extern const struct kiln_option_type kiln_type_frames;    /* ascending */
extern const struct kiln_option_type kiln_type_limits;    /* {metric: value} */
extern const struct kiln_option_type kiln_type_rectangle; /* [x, y, w, h], or none */
extern const struct kiln_option_type kiln_type_mask;      /* a rectangle or a picture */

/* The C types of their fields (option/option.h). */
typedef const char *kiln_fills_override;
typedef const char *kiln_fills_technique;
typedef const char *kiln_fills_device;
typedef uint32_t kiln_fills_size[2];
typedef uint32_t kiln_fills_frames[];
typedef struct kiln_expect_value kiln_fills_limits[];
typedef uint32_t kiln_fills_rectangle[4];
typedef struct kiln_test_mask kiln_fills_mask;

/* An item of a list of masks. */
extern const struct kiln_option kiln_mask_item;
typedef struct kiln_test_mask kiln_mask_item_fills;

#endif
