/* Finds the number of the work group. Dispatches have two dimensions, since one takes only 65535
 * work groups. */
#ifndef KILN_SORT_INDEX_GLSL
#define KILN_SORT_INDEX_GLSL

uint group_index()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

#endif
