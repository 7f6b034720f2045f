/* Names the processor of this machine, for reports. */
#ifndef KILN_BASE_CPU_H
#define KILN_BASE_CPU_H

/* Fills in the processor's name as the system gives it, or its architecture where it gives none. */
void kiln_cpu_name(char name[128]);

#endif
