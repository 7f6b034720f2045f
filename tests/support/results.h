/* Results of tests built by hand. Include it after cmocka.h. */
#ifndef KILN_TESTS_RESULTS_H
#define KILN_TESTS_RESULTS_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "suite/result.h"

/* A result in which nothing is said. */
static inline struct kiln_result test_empty_result(const char *name)
{
    return (struct kiln_result){
        .name = name,
        .test = "",
        .scene = "",
        .about = "",
        .golden = "",
        .message = "",
        .log = "",
        .device = "",
        .device_name = "",
        .driver = "",
        .platform = "",
        .techniques = "",
        .techniques_expected = "",
        .version = "",
        .scene_hash = "",
        .scene_hash_expected = "",
        .started = "",
        .rerun = "",
        .approve = "",
    };
}

static inline struct kiln_result_frame test_empty_frame(uint32_t number)
{
    return (struct kiln_result_frame){
        .number = number,
        .message = "",
        .picture = "",
        .reference = "",
        .error_map = "",
        .golden = "",
        .state = "",
        .state_expected = "",
        .pixels = "",
        .pixels_expected = "",
    };
}

#endif
