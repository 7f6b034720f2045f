/* Includes cmocka.h after the four headers of the C library that it needs but does not include.
 * Here clang-format cannot sort them into another order. */
#ifndef KILN_TESTS_CMOCKA_H
#define KILN_TESTS_CMOCKA_H

/* clang-format off */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
/* clang-format on */

#endif
