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

extern const struct kiln_option_type kiln_type_override;  /* key=value; const char * */
extern const struct kiln_option_type kiln_type_technique; /* stage=name; const char * */
extern const struct kiln_option_type kiln_type_device; /* as in kiln_device_params; const char * */
extern const struct kiln_option_type kiln_type_size;   /* [w, h], or scene; uint32_t[2] */
extern const struct kiln_option_type kiln_type_frames; /* uint32_t[], ascending; count */
extern const struct kiln_option_type kiln_type_limits; /* struct kiln_expect_value[]; count */
extern const struct kiln_option_type kiln_type_rectangle; /* uint32_t[4]; or none */
extern const struct kiln_option_type kiln_type_mask;      /* struct kiln_test_mask */

/* An item of a list of masks. */
extern const struct kiln_option kiln_mask_item;

#endif
