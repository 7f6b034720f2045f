/* Computes the arithmetic that a file may write in the place of a number: "= 2 * $length + 1 s". */
#ifndef KILN_OPTION_EXPRESSION_H
#define KILN_OPTION_EXPRESSION_H

#include "option/reader.h"

/* The base units that a quantity is made of. A fraction, such as 50 %, is a plain number. */
enum { KILN_BASE_UNITS = 6 };

/* A number in SI, and the powers of its base units. */
struct kiln_quantity {
    double value;
    int powers[KILN_BASE_UNITS]; /* s, m, rad, K, px, stops */
};

/* Returns the quantity of a number in a dimension, in SI. */
struct kiln_quantity kiln_quantity_of(enum kiln_dimension dimension, double value);

/* Returns whether two quantities have the same units. */
bool kiln_quantity_fits(const struct kiln_quantity *a, const struct kiln_quantity *b);

/* Finds the dimension that has the units of a quantity. False if there is none, such as of m*s. */
bool kiln_quantity_dimension(const struct kiln_quantity *quantity, enum kiln_dimension *dimension);

/* Returns whether a scalar is arithmetic: whether its text begins with '='. */
bool kiln_expression_is(const struct kiln_node *node);

/* Computes the arithmetic of a scalar, whose names are those of reader->params. Every machine gets
 * the same bits. False with an error at the scalar. */
bool kiln_expression_compute(struct kiln_reader *reader, const struct kiln_node *node,
                             struct kiln_quantity *quantity);

/* Computes the arithmetic of a scalar for a row, in the row's SI unit, without checking limits. A
 * result without a unit is taken as in the row's unit, but not where a number must have its unit.
 */
bool kiln_expression_read(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, double *value);

#endif
