/* Suggests kiln's spelling for options of ffmpeg, Blender, Houdini's husk and other renderers.
 *
 * The parser of options (options.c) asks for a suggestion when a command has no option of the name
 * that was typed. So a row never hides an option of kiln's own.
 *
 * The first row is used whose `typed` is the argument and whose `option` the command has. A row
 * without an option suits every command, so it must be the last of the rows with the same `typed`
 * ("--out" has two). Apart from that, rows may be added anywhere. A hint and the "; " before it
 * must fit into FOREIGN_SIZE, or the hint is cut off. tests/cli/cases/foreign.t has messages. */
#include "foreign.h"

#include <string.h>

struct foreign {
    const char *typed;  /* the option as another program spells it, with its dashes */
    const char *option; /* kiln's option, which the command must have; NULL: any command */
    const char *hint;   /* a sentence to print; NULL prints "did you mean '--OPTION'?" */
};

#define FRAMES_HINT "'--frames' chooses frames, such as --frames 10-50"
#define FIRST_HINT  "'--frames' chooses frames, such as --frames 10- from frame 10 on"
#define FINAL_HINT  "'--frames' chooses frames, such as --frames -50 up to frame 50"
#define STEP_HINT   "'--frames 0-100/10' draws every tenth frame"
#define SUFFIX_HINT "the suffix of '--output' chooses the format (see 'kiln help outputs')"
#define CAMERA_HINT                                                                                \
    "a scene has one camera, such as '--set camera.position=[0,1,5] --set camera.target=[0,1,0]'"
#define SCENE_HINT "an input file is an operand and needs no option"

static const struct foreign rows[] = {
    /* ffmpeg; -f, -s and -t mean something else to Blender */
    {"-y", "force", NULL},
    {"-r", "fps", NULL},
    {"-framerate", "fps", NULL},
    {"-i", NULL, SCENE_HINT},
    {"-s:v", "size", NULL},
    {"-video_size", "size", NULL},
    {"-f", "frames", "'--frames' chooses frames, and the suffix of '--output' the format"},
    {"-s", "size", "'--size WxH' sets the size; '--frames' chooses frames"},
    {"-t", "threads",
     "'--threads N' sets the number of threads; '--frames' sets the length of a clip"},
    {"-ss", "frames", FIRST_HINT},
    {"-frames:v", "frames", FRAMES_HINT},
    {"-vframes", "frames", FRAMES_HINT},
    {"-vf", "size", "kiln has no filters; '--size WxH' sets the size"},
    {"-crf", "quality", NULL},
    {"-q:v", "quality", NULL},
    {"-qscale:v", "quality", NULL},
    {"-c:v", "output", SUFFIX_HINT},
    {"-vcodec", "output", SUFFIX_HINT},
    {"-pix_fmt", "output", SUFFIX_HINT},
    {"-threads", "threads", NULL},
    {"-loglevel", "quiet", NULL},
    {"-hide_banner", "quiet", NULL},
    {"-stats", "stats", NULL},

    /* Blender */
    {"-b", NULL, "kiln always works without a window"},
    {"--background", NULL, "kiln always works without a window"},
    {"--frame-start", "frames", FIRST_HINT},
    {"-e", "frames", FINAL_HINT},
    {"--frame-end", "frames", FINAL_HINT},
    {"--render-frame", "frames", FRAMES_HINT},
    {"-j", "frames", STEP_HINT},
    {"--frame-jump", "frames", STEP_HINT},
    {"-a", "frames", "kiln draws every frame unless '--frames' chooses some"},
    {"--render-anim", "frames", "kiln draws every frame unless '--frames' chooses some"},
    {"--render-output", "output", NULL},
    {"-F", "output", SUFFIX_HINT},
    {"--render-format", "output", SUFFIX_HINT},
    {"-x", "output", SUFFIX_HINT},
    {"--use-extension", "output", SUFFIX_HINT},
    {"-E", "technique", NULL},
    {"-S", NULL, SCENE_HINT},
    {"--engine", "technique", NULL},

    /* husk and other renderers */
    {"--frame", "frames", NULL},
    {"--frame-count", "frames", FRAMES_HINT},
    {"-n", "frames", FRAMES_HINT},
    {"--frame-inc", "frames", STEP_HINT},
    {"--frame-step", "frames", STEP_HINT},
    {"--start", "frames", FIRST_HINT},
    {"--end", "frames", FINAL_HINT},
    {"--range", "frames", NULL},
    {"--res", "size", NULL},
    {"--resolution", "size", NULL},
    {"--width", "size", NULL},
    {"--height", "size", NULL},
    {"--renderer", "technique", NULL},
    {"-R", "technique", NULL},
    {"--gpu", "device", NULL},
    {"--framerate", "fps", NULL},
    {"--frame-rate", "fps", NULL},
    {"-c", "set", CAMERA_HINT},
    {"--camera", "set", CAMERA_HINT},
    {"--samples", "set",
     "'--set camera.shutter.samples=16' sets the number of samples in the shutter's time"},
    {"--pixel-samples", "set",
     "'--set camera.shutter.samples=16' sets the number of samples in the shutter's time"},
    {"--snapshot", "resume", "'--resume' keeps whole files and goes on from there"},
    {"--make-output-path", "output", "kiln makes missing folders of '--output'"},

    /* spellings of many programs */
    {"--overwrite", "force", NULL},
    {"--yes", "force", NULL},
    {"--replace", "force", NULL},
    {"--clobber", "force", NULL},
    {"--out", "output", NULL},
    {"--outfile", "output", NULL},
    {"--out", NULL, "the output is an operand, or another option sets it ('--help')"},
    {"--output-file", "output", NULL},
    {"--output-dir", "output", NULL},
    {"--outdir", "output", NULL},
    {"--input", NULL, SCENE_HINT},
    {"--scene", NULL, SCENE_HINT},
    {"--file", NULL, SCENE_HINT},
    {"--format", "output", SUFFIX_HINT},
    {"--codec", "output", SUFFIX_HINT},
    {"--crf", "quality", NULL},
    {"--jobs", "threads", NULL},
    {"--workers", "threads", NULL},
    {"--cores", "threads", NULL},
    {"--param", "set", NULL},
    {"--define", "set", NULL},
    {"-D", "set", NULL},
    {"--continue", "resume", NULL},
    {"--skip-existing", "resume", NULL},
    {"--assets", "asset-root", NULL},
    {"--asset-path", "asset-root", NULL},
    {"--timeout", "test-timeout", NULL},
    {"--limits", "tolerance", NULL},
    {"--runs", "repeat", NULL},
    {"--font-size", "text-size", NULL},
    {"--theme", "dark", "'--dark' draws light lettering on dark paper"},
    {"--silent", "quiet", NULL},
    {"--verbose", "stats", NULL},
    {"-v", "stats", "'--stats' prints more; 'kiln --version' prints the version"},
    {"-V", NULL, "'kiln --version' prints the version"},
    {"--version", NULL, "'kiln --version' prints the version"},
    {"-?", "help", NULL},
    {"--usage", "help", NULL},
};

static bool has_option(const struct option *options, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(options[i].name, name) == 0)
            return true;
    }
    return false;
}

bool foreign_suggest(char out[FOREIGN_SIZE], const char *typed, const struct option *options,
                     size_t option_count)
{
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct foreign *row = &rows[i];
        if (strcmp(row->typed, typed) != 0 ||
            (row->option && !has_option(options, option_count, row->option)))
            continue;
        if (row->hint)
            snprintf(out, FOREIGN_SIZE, "; %s", row->hint);
        else
            snprintf(out, FOREIGN_SIZE, " (did you mean '--%s'?)", row->option);
        return true;
    }
    return false;
}
