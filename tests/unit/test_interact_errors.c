/* What is said of scenes whose particles cannot interact as they are told. */
#include <stddef.h>
#include <stdint.h>

#include "support/bad_scenes.h"
#include "support/cmocka.h"

static const struct bad interactions[] = {
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [collide: 1 cm, collide: {radius: 2 cm}]\n",
     ":4:15: systems.a.interact: entries 0 and 1 are of the same kind; one entry of each kind is "
     "allowed"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [collide: 0 m]\n",
     ":4:15: systems.a.interact: the radius of entry 0 is 0 at all times, so nothing can collide; "
     "it must be above 0"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [collide: {rounds: 0}]\n",
     ":4:34: systems.a.interact.0.collide.rounds: 0 is out of range; allowed is from 1 to 64"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [collide: {mode: staged}]\n",
     ":4:32: systems.a.interact.0.collide.mode: expected exact or staggered, found 'staged'"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [{collide: {radius: -1 cm}}]\n",
     ":4:35: systems.a.interact.0.collide.radius: -1 cm is out of range; allowed is from 0 m to "
     "1000 m"},
    {"kiln: 1\n"
     "systems:\n"
     "  stars: {}\n"
     "  a:\n"
     "    interact: [{gravity: {of: star}}]\n",
     ":5:31: systems.a.interact.0.gravity.of: unknown system 'star' (did you mean 'stars'?)"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [{flock: {slowest: 2, fastest: 1}}]\n",
     ":4:15: systems.a.interact: the slowest speed of a flock, 2 m/s, is above its fastest, 1 m/s"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [flock: 0 m]\n",
     ":4:23: systems.a.interact.0.flock.radius: 0 m is out of range; allowed is from 0.001 m to "
     "1000 m"},
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    emit: {rate: 600000, life: 2 s}\n"
     "    interact: [flock: 1 m]\n",
     ":4:11: systems.a.emit: a flock has up to 1220000 particles at once; at most 1048576 are "
     "allowed: lower rate, bursts or life"},
};
BAD_TEST(interactions)

int main(void)
{
    static const struct CMUnitTest tests[] = {cmocka_unit_test(bad_interactions)};
    return cmocka_run_group_tests_name("interact_errors", tests, NULL, NULL);
}
