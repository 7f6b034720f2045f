/* Creates the stage that draws opaque particles (kiln_solids) and the images that it draws to, and
 * draws particles, for tests that read the pixels. */
#include "support/opaque.h"

#include "support/cmocka.h"

void opaque_init(struct fixture *f, struct kiln_device *device, const char *text,
                 const char *const *overrides, size_t count)
{
    struct kiln_error error = {0};
    struct drawing *d = &f->drawing;
    drawing_init(d, device, text, overrides, count);
    kiln_image_init(&f->color, device, WIDTH, HEIGHT, GL_RGBA32F, "scene");
    kiln_image_init(&f->depth, device, WIDTH, HEIGHT, GL_R32F, "scene depth");
    kiln_image_init(&f->bloom, device, WIDTH, HEIGHT, GL_RGBA32F, "bloom");
    const struct kiln_solids_params params = {
        .backdrop = d->backdrop,
        .threads = d->threads,
        .targets = {&d->backdrop_color, &d->backdrop_depth, &f->color, &f->depth, &f->bloom},
    };
    f->stage = kiln_solids_create(device, &d->moment, &params, &error);
    if (!f->stage)
        fail_msg("%s", error.message);
}

void opaque_finish(struct fixture *f)
{
    kiln_solids_destroy(&f->stage);
    kiln_image_finish(&f->color);
    kiln_image_finish(&f->depth);
    kiln_image_finish(&f->bloom);
    drawing_finish(&f->drawing);
}

void opaque_draw(struct fixture *f, uint32_t count)
{
    struct kiln_error error = {0};
    struct drawing *d = &f->drawing;
    if (!kiln_solids_draw(f->stage, &d->moment, &d->entries, count, &error))
        fail_msg("%s", error.message);
    struct kiln_image *images[] = {&f->color, &f->depth, &f->bloom, &d->backdrop_color,
                                   &d->backdrop_depth};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        assert_non_null(kiln_image_host(images[i], KILN_READ, &error));
}
