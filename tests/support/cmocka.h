/* cmocka, with the four headers of the C library that have to be included before it. */
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
