/* Includes cmocka.h, the framework of kiln's C tests, after the four headers of the C library that
 * it needs but does not include. clang-format is off here, since it would change their order. */
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
