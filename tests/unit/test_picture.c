/* Pictures that return to the spare ones when they are destroyed. */
#include <pthread.h>
#include <stddef.h>
#include <string.h>

#include "output/output.h"
#include "support/cmocka.h"

static struct kiln_picture *make(struct kiln_spare_pictures *spares)
{
    static const char *const names[] = {"beauty"};
    static const uint32_t channels[] = {4};
    struct kiln_error error = {0};
    struct kiln_picture *picture = kiln_picture_create(16, 8, 8, names, channels, 1, &error);
    assert_non_null(picture);
    kiln_spare_pictures_add(spares, picture);
    return picture;
}

static void a_destroyed_picture_is_taken_again(void **state)
{
    (void)state;
    struct kiln_spare_pictures *spares = kiln_spare_pictures_create();
    assert_null(kiln_spare_pictures_take(spares));
    struct kiln_picture *first = make(spares), *second = make(spares);
    const void *pixels = first->layers[0].pixels;
    first->has_alpha = first->is_data = true;
    struct kiln_picture *shared = kiln_picture_share(first);
    kiln_picture_destroy(&first);
    assert_null(kiln_spare_pictures_take(spares)); /* another one holds it */
    kiln_picture_destroy(&shared);
    struct kiln_picture *again = kiln_spare_pictures_take(spares);
    assert_non_null(again);
    assert_ptr_equal(again->layers[0].pixels, pixels);
    assert_false(again->has_alpha || again->is_data);
    assert_true(again->width == 16 && again->height == 8 && again->bits == 8);
    assert_string_equal(again->layers[0].name, "beauty");
    assert_null(kiln_spare_pictures_take(spares));
    kiln_picture_destroy(&again);
    kiln_picture_destroy(&second);
    kiln_spare_pictures_destroy(&spares);
    assert_null(spares);
}

/* An encoder may hold a picture for longer than the renderer lives. */
static void pictures_may_outlive_the_spare_ones(void **state)
{
    (void)state;
    struct kiln_spare_pictures *spares = kiln_spare_pictures_create();
    struct kiln_picture *first = make(spares), *second = make(spares), *spare = make(spares);
    kiln_picture_destroy(&spare);
    kiln_spare_pictures_destroy(&spares);
    memset(first->layers[0].pixels, 1, 16 * 8 * 4 * sizeof(float));
    kiln_picture_destroy(&first);
    memset(second->display, 1, 16 * 8 * 4);
    kiln_picture_destroy(&second);
}

enum { TURNS = 2000 };

static void *take_and_destroy(void *user)
{
    struct kiln_spare_pictures *spares = user;
    for (int i = 0; i < TURNS; i++) {
        struct kiln_picture *picture = kiln_spare_pictures_take(spares);
        if (!picture)
            picture = make(spares);
        picture->frame = (uint32_t)i;
        kiln_picture_destroy(&picture);
    }
    return NULL;
}

static void threads_take_different_pictures(void **state)
{
    (void)state;
    struct kiln_spare_pictures *spares = kiln_spare_pictures_create();
    pthread_t threads[3];
    for (int i = 0; i < 3; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, take_and_destroy, spares), 0);
    for (int i = 0; i < 3; i++)
        pthread_join(threads[i], NULL);
    size_t count = 0;
    struct kiln_picture *left[3];
    while (count < 3 && (left[count] = kiln_spare_pictures_take(spares)))
        count++;
    assert_true(count >= 1 && !kiln_spare_pictures_take(spares));
    for (size_t i = 0; i < count; i++)
        kiln_picture_destroy(&left[i]);
    kiln_spare_pictures_destroy(&spares);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_destroyed_picture_is_taken_again),
        cmocka_unit_test(pictures_may_outlive_the_spare_ones),
        cmocka_unit_test(threads_take_different_pictures),
    };
    return cmocka_run_group_tests_name("picture", tests, NULL, NULL);
}
