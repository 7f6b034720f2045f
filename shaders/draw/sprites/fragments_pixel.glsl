/* The pixel that a fragment is of, as lists are numbered. */
uniform uint row_length; /* pixels */

uint pixel_number()
{
    return uint(gl_FragCoord.y) * row_length + uint(gl_FragCoord.x);
}
