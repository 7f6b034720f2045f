/* Declares the function that names the processor of this machine. `kiln bench` writes the name into
 * its results (lib/bench/result.c), and `kiln figure` into the record that it keeps in a file
 * beside a picture for a document (lib/figure/panels.c). `kiln figure check` compares the name with
 * the recorded one. Do not change how the name is written: records made before would then name
 * another processor. */
#ifndef KILN_BASE_CPU_H
#define KILN_BASE_CPU_H

/* Writes the processor's name as the system gives it ("AMD EPYC 7763"), or the machine's
 * architecture ("aarch64") where the system gives no name; "" where it gives neither. */
void kiln_cpu_name(char name[128]);

#endif
