/* Finds the number of a fragment's pixel, by which the lists of fragments are indexed: row by row
 * of the picture. */
uniform uint row_length; /* of the picture, pixels */

uint pixel_number()
{
    return uint(gl_FragCoord.y) * row_length + uint(gl_FragCoord.x);
}
