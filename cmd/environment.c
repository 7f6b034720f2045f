/* Lists the variables of the environment that kiln reads, one row each. The help and the man page
 * are printed from the rows. tests/tree/environment.sh checks that each getenv of the tree has a
 * row. */
#include "command.h"

const struct variable variables[] = {
    {"KILN_SIMD",
     "Vectors of the techniques 'cpu': plain, sse4.1, avx2, avx512 or neon, as the machine has "
     "them; the pixels are the same."},
    {"KILN_LIMITS", "Limits of jobs where --limits says nothing else (see 'kiln help limits')."},
    {"KILN_SANDBOX",
     "Whether jobs confine themselves, where --sandbox says nothing else: on, require or "
     "off."},
    {"KILN_LIBEXEC_DIR", "The folder of kiln-decode, which reads pictures, videos and meshes, "
                         "where it is not beside the program."},
    {"KILN_SHADER_DIR", "Read shaders from this folder instead of those in the program."},
    {"KILN_BATCH_PROCESS",
     "Set by 'kiln render --batch' for its jobs: the process that they end with."},
    {"XDG_CACHE_HOME",
     "What takes long to make (flipbooks, distance fields of meshes) is kept in its folder kiln, "
     "instead of in that of ~/.cache, and serves later jobs; /dev/null: nothing is."},
    {"HOME", "Whose .cache/kiln that is; without both, nothing is kept from run to run."},
    {"TMPDIR", "Where 'kiln bench' and 'kiln test calibrate' write pictures that they remove "
               "again, instead of /tmp."},
    {"NO_COLOR", "Where it is set, terminals get no colours."},
    {"TERM", "Where it is 'dumb' or not set, 'kiln test' prints no colours either."},
    {"SLURM_ARRAY_TASK_ID",
     "Which task of a job array this is, for 'kiln render --shard auto' under Slurm."},
    {"SLURM_ARRAY_TASK_MIN", "The number of the first task there."},
    {"SLURM_ARRAY_TASK_STEP", "From one number to the next."},
    {"SLURM_ARRAY_TASK_COUNT", "How many tasks there are."},
    {"SGE_TASK_ID", "Which task this is under Grid Engine; 'undefined' outside of arrays."},
    {"SGE_TASK_FIRST", "The number of the first task there."},
    {"SGE_TASK_STEPSIZE", "From one number to the next."},
    {"SGE_TASK_LAST", "The number of the last task."},
    {"JOB_COMPLETION_INDEX", "Which task this is, from 0, in an indexed job of Kubernetes."},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "Which task this is, from 0, in an array of AWS Batch."},
    {"LP_NUM_THREADS",
     "Threads of Mesa's software device. 'kiln test' sets it where it is not set, "
     "so that its jobs share the cores."},
    {"LD_LIBRARY_PATH",
     "Folders of libraries, which a job with --sandbox may read besides those of the system."},
    {NULL, NULL},
};

bool help_write_environment(FILE *out)
{
    fputs(
        "Variables of the environment that kiln reads; an option of the same purpose comes first.\n"
        "kiln-decode gets those that begin with KILN_ or LD_, LANG, those of sanitizers, and no "
        "others.\n\n",
        out);
    for (const struct variable *row = variables; row->name; row++) {
        fprintf(out, "  %s\n      ", row->name);
        help_print_wrapped(out, row->meaning, 6, 6);
    }
    return !ferror(out);
}
