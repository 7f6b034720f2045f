/* Lists the variables of the environment that kiln reads, one row each. The help and the man page
 * are printed from the rows. tests/tree/environment.sh checks that each getenv of the tree has a
 * row. */
#include "command.h"

const struct variable variables[] = {
    {"KILN_SIMD", "Vector width of the techniques 'cpu': plain, avx2, avx512 or neon, as "
                  "the machine has them. The pixels are the same with each."},
    {"KILN_LIMITS", "Limits of jobs where --limits does not set them (see 'kiln help limits')."},
    {"KILN_SANDBOX",
     "Whether jobs confine themselves where --sandbox is not given: on, require or off."},
    {"KILN_LIBEXEC_DIR", "The folder of kiln-decode where it is not beside the program. "
                         "kiln-decode reads pictures, videos and meshes."},
    {"KILN_LOG", "Which messages are printed besides errors: warning (the default), info or debug. "
                 "With debug, the place in kiln's source stands before an error."},
    {"KILN_SHADER_DIR",
     "The folder that shaders are read from, instead of the shaders in the program."},
    {"KILN_BATCH_PROCESS", "Set by 'kiln render --batch' for its jobs: the process ID of the "
                           "batch, with which a job ends."},
    {"XDG_CACHE_HOME",
     "The folder in which kiln keeps results that take long to make for later jobs, instead of "
     "~/.cache: flipbooks and distance fields of meshes in a folder kiln, built programs of OpenGL "
     "in a folder kiln-programs. The second is used only where nobody but this user has rights to "
     "it and others cannot rename it. /dev/null keeps nothing."},
    {"HOME", "The home folder, whose .cache keeps results where XDG_CACHE_HOME is not set. "
             "Without both variables, nothing is kept from run to run."},
    {"TMPDIR", "The folder in which 'kiln bench' and 'kiln test calibrate' write temporary "
               "pictures, instead of /tmp."},
    {"NO_COLOR", "Where it is set, kiln writes no colours to terminals."},
    {"TERM", "Where it is 'dumb' or not set, 'kiln test' writes no colours."},
    {"SLURM_ARRAY_TASK_ID",
     "Number of this task in a job array of Slurm, for 'kiln render --shard auto'."},
    {"SLURM_ARRAY_TASK_MIN", "Number of the first task in Slurm's job array."},
    {"SLURM_ARRAY_TASK_STEP",
     "Difference between the numbers of two neighbouring tasks in Slurm's job array."},
    {"SLURM_ARRAY_TASK_COUNT", "Number of tasks in Slurm's job array."},
    {"SGE_TASK_ID", "Number of this task under Grid Engine, for 'kiln render --shard auto'; "
                    "'undefined' outside of arrays."},
    {"SGE_TASK_FIRST", "Number of the first task in Grid Engine's array."},
    {"SGE_TASK_STEPSIZE",
     "Difference between the numbers of two neighbouring tasks in Grid Engine's array."},
    {"SGE_TASK_LAST", "Number of the last task in Grid Engine's array."},
    {"JOB_COMPLETION_INDEX", "Number of this task, from 0, in an indexed job of Kubernetes."},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "Number of this task, from 0, in an array of AWS Batch."},
    {"LP_NUM_THREADS", "Number of threads of Mesa's software device. 'kiln test' sets it where it "
                       "is not set, so that its jobs share the cores."},
    {"LD_LIBRARY_PATH",
     "Folders of libraries that a job with --sandbox may read besides those of the system."},
    {NULL, NULL},
};

bool help_write_environment(FILE *out)
{
    fputs(
        "These are the variables of the environment that kiln reads. An empty variable counts as "
        "one "
        "that\nis not set. An option of the same purpose overrides its variable. kiln-decode gets "
        "only variables\nthat begin with KILN_ or LD_, LANG, those of sanitizers, and "
        "GLIBC_TUNABLES, which kiln sets for it.\n\n",
        out);
    for (const struct variable *row = variables; row->name; row++) {
        fprintf(out, "  %s\n      ", row->name);
        help_print_wrapped(out, row->meaning, 6, 6);
    }
    return !ferror(out);
}
