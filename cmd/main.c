/* The program: picks the subcommand. */
#include "kiln.h"

int main(void)
{
    puts("kiln " KILN_VERSION);
    return KILN_USAGE;
}
