/* Declares what those who make the parts of ribbons (shared/ribbon.h) and those who draw them agree
 * on. */
#ifndef KILN_SHARED_RIBBON_LAYOUT_H
#define KILN_SHARED_RIBBON_LAYOUT_H

#define RIBBON_BEGINS  1u /* the ribbon begins here, or is cut */
#define RIBBON_ENDS    2u /* it ends here, or is cut */
#define RIBBON_REPEATS 4u /* its texture repeats along it */

/* How far the corners of a ribbon that bends reach beyond the joint's middle, in half widths: those
 * of a bend by 120 degrees. */
#define RIBBON_CORNER 1.7320508f

#endif
