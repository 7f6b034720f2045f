/* This file describes the keys of a scene: it writes the reference for people and the JSON schema
 * for editors. */
#include "option/reference.h"
#include "option/schema.h"
#include "scene/options.h"

static const char scene_introduction[] =
    "A scene is a YAML file. Every key below may also be given with --set KEY=VALUE; '*' in a KEY\n"
    "stands for every entry of a mapping or list, and entries of a list are counted from 0.\n"
    "\n"
    "Numbers may carry a unit (2 s, 45 deg); without one they are in the SI unit, except that an\n"
    "angle always needs one. Where it is allowed, a number, vector or colour may vary over a "
    "clock:\n"
    "\n"
    "    {keys: {0 s: 1, 3 s: 2}}      time; 0 s is the first frame\n"
    "    {life: [0.1, 1.2]}            a particle's life, evenly spread from birth to death\n"
    "    {life: {0: 0, 0.2: 1, 1: 0}}  the same with the parts of the life named\n"
    "    {age: {0 s: 1, 0.2 s: 0}}     time since a particle's birth\n"
    "    {speed: {0: 900, 20: 1800}}   its speed; also height, its y, and distance to the eye\n"
    "    {random: [0.2, 0.6]}          a number that each particle draws once; keys are quantiles\n"
    "    {choose: [red, white]}        one of a list; weights: [3, 1] makes some more likely\n"
    "    {noise: [0.8, 1.2]}           a smooth noise over time; period: 1 s, octaves: 1,\n"
    "                                  per: system or particle\n"
    "\n"
    "Beside the clock may stand ease: linear, smooth, step, in or out; repeat: loop or mirror;\n"
    "times: a factor, and plus: a value to add, which may vary, too; seed: N for random numbers\n"
    "that agree. The first value holds before the first key, and the last value after the last\n"
    "key. A vector or colour varies as a whole ({keys: {0 s: [1, 0, 0], 1 s: [0, 1, 0]}}) or in\n"
    "each component.\n"
    "\n"
    "Lengths are in metres. The axes are right-handed, with y up.\n"
    "Numbers of colours are linear light, with Rec. 709 primaries. \"#e61e28\", \"#abc\" and the "
    "names\n"
    "of CSS, such as orange or rebeccapurple, are sRGB, wherever a colour stands.\n"
    "\n"
    "A scene may be made of parts, and have parameters:\n"
    "\n"
    "    include: [parts/fire.yaml]                   its keys lie under those of the scene\n"
    "    systems: {left: {use: flames}}               a copy of another system, with changes\n"
    "    params: {amount: {number: 1, min: 0, max: 3}}\n"
    "    rate: $amount                                the value of a parameter; $$x is the text "
    "$x\n"
    "    rate: \"= 2 * max($amount, 0.5)\"             arithmetic in the place of a number\n"
    "\n"
    "Anchors, aliases and << of YAML are read. 'kiln check' prints the scene with all of this\n"
    "resolved; its option --origin adds the file and line that each key comes from.\n"
    "\n";

bool kiln_scene_write_reference(FILE *out)
{
    return kiln_reference_write(out, scene_introduction, kiln_options_root);
}

bool kiln_scene_write_keys(FILE *out, const char *below, const char *text, size_t *count)
{
    return kiln_reference_write_some(out, kiln_options_root, below, text, count);
}

const char *kiln_scene_introduction(void)
{
    return scene_introduction;
}

bool kiln_scene_visit_keys(void (*visit)(void *user, const struct kiln_option_key *key), void *user)
{
    return kiln_reference_visit(kiln_options_root, visit, user);
}

bool kiln_scene_write_schema(FILE *out)
{
    return kiln_schema_write(out, "kiln scene", kiln_options_root);
}
