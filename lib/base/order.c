/* This file orders names of numbered files: numbers by their values, all else by its bytes. */
#include "base/order.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_alphanumeric(char c)
{
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           (unsigned char)c >= 128;
}

/* A number in a name: its digits without leading zeros. */
struct number {
    const char *digits;
    size_t count;
    bool negative;
    const char *end;
};

/* Reads the number at a place of a name. Returns false where there is none. */
static bool read_number(const char *name, const char *at, struct number *number)
{
    const bool sign = *at == '-' && (at == name || !is_alphanumeric(at[-1]));
    const char *digits = sign ? at + 1 : at;
    if (!is_digit(*digits))
        return false;
    while (*digits == '0' && is_digit(digits[1]))
        digits++;
    size_t count = 0;
    while (is_digit(digits[count]))
        count++;
    const bool zero = count == 1 && *digits == '0';
    *number = (struct number){digits, count, sign && !zero, digits + count};
    return true;
}

static int compare_numbers(const struct number *a, const struct number *b)
{
    if (a->negative != b->negative)
        return a->negative ? -1 : 1;
    int order = (a->count > b->count) - (a->count < b->count);
    if (order == 0)
        order = strncmp(a->digits, b->digits, a->count);
    return a->negative ? -order : order;
}

int kiln_order_names(const char *a, const char *b)
{
    const char *p = a, *q = b;
    while (*p && *q) {
        struct number m, n;
        if (read_number(a, p, &m) && read_number(b, q, &n)) {
            const int order = compare_numbers(&m, &n);
            if (order != 0)
                return order;
            p = m.end;
            q = n.end;
        } else if (*p != *q) {
            break;
        } else {
            p++;
            q++;
        }
    }
    const int order = (unsigned char)*p - (unsigned char)*q;
    return order != 0 ? order : strcmp(a, b);
}

/* Returns the value of a number; of a longer one than such numbers have, some large value. */
static int64_t value_of(const struct number *number)
{
    int64_t value = 0;
    for (size_t i = 0; i < number->count && value <= 10000000000; i++)
        value = 10 * value + (number->digits[i] - '0');
    return number->negative ? -value : value;
}

uint32_t kiln_order_gap(const char *a, const char *b)
{
    const char *p = a, *q = b;
    int64_t gap = 0;
    while (*p || *q) {
        struct number m, n;
        if (read_number(a, p, &m) && read_number(b, q, &n)) {
            if (compare_numbers(&m, &n) != 0) {
                const int64_t step = value_of(&n) - value_of(&m);
                if (gap != 0 || step <= 0)
                    return 0;
                gap = step;
            }
            p = m.end;
            q = n.end;
        } else if (*p != *q) {
            return 0;
        } else {
            p++;
            q++;
        }
    }
    return gap > 1000000 ? 999999 : gap > 1 ? (uint32_t)(gap - 1) : 0;
}
