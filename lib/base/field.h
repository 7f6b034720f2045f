/* Lets the compiler check rows of tables that bind a name to a field of a struct by its offset. A
 * row whose code would write another type of C than the field's does not compile. */
#ifndef KILN_BASE_FIELD_H
#define KILN_BASE_FIELD_H

#include <stddef.h>

/* Is 0 in a constant expression, and does not compile unless the condition holds; the compiler then
 * prints the message. An initialiser may add it to a number or to the address of an array. */
#define KILN_FIELD_ASSERT(condition, message)                                                      \
    (0 * sizeof(struct {                                                                           \
         char unused;                                                                              \
         _Static_assert(condition, message);                                                       \
     }))

/* Is 1 if the pointer has a type, or a compatible one, and otherwise 0. Arrays of unknown and of
 * known length are compatible, as are unsigned and an enum without negative values. */
#define KILN_FIELD_IS(pointer, pointer_type) _Generic((pointer), pointer_type : 1, default : 0)

/* Is the offset of a member, and does not compile unless the member has the type c_type. */
#define KILN_FIELD_OFFSET(struct_, member, c_type, message)                                        \
    (offsetof(struct_, member) +                                                                   \
     KILN_FIELD_ASSERT(KILN_FIELD_IS(&((struct_ *)NULL)->member, c_type *), message))

#endif
