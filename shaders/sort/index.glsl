/* Which work group this is of a dispatch in two dimensions: one axis takes only 65535. */
#ifndef KILN_SORT_INDEX_GLSL
#define KILN_SORT_INDEX_GLSL

uint group_index()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

#endif
