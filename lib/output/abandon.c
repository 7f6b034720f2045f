/* The public door to kiln_output_abandon_all, for programs that end in the middle of a job. */
#include "output/output.h"

void kiln_abandon_outputs(void)
{
    kiln_output_abandon_all();
}
