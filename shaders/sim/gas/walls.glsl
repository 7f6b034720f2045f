/* Finds the walls of bricks beside solids. */
#ifndef KILN_SIM_GAS_WALLS_GLSL
#define KILN_SIM_GAS_WALLS_GLSL

/* Returns where the wall of a brick begins, or ~0 where it has none. */
uint wall_of(uint brick)
{
    uint number = brick_words[brick] >> GAS_WALL_SHIFT;
    return number != 0u ? (number - 1u) * uint(GAS_WALL_WORDS) : 0xffffffffu;
}

/* Returns the bits of a cell. Beyond the window they are those of the nearest cell. */
uint wall_bits(ivec3 cell)
{
    ivec3 own = nearest(cell);
    uint wall = wall_of(brick_of(own));
    return wall != 0xffffffffu ? wall_words[wall + cell_in_brick(own)] : 0u;
}

/* Returns the open part of a cell's lower face on an axis. */
float wall_open(uint wall, uint axis, uint cell)
{
    return uintBitsToFloat(wall_words[wall + (1u + axis) * uint(GAS_BRICK_CELLS) + cell]);
}

/* Returns the speed of the solid across it, m/s. */
float wall_speed(uint wall, uint axis, uint cell)
{
    return uintBitsToFloat(wall_words[wall + (4u + axis) * uint(GAS_BRICK_CELLS) + cell]);
}

#endif
