/* picture SCENE FRAME FILE.ppm: draws one frame of a scene into memory, reads its pixels, and
 * writes them into a file itself. */
#include <kiln.h>
#include <stdio.h>
#include <stdlib.h>

/* The state of the callback `take`, which writes the pixels into a PPM file and finds their
 * brightest value. */
struct canvas {
    FILE *file;
    unsigned brightest;
};

static void take(void *user, const struct kiln_frame_layer *layer)
{
    struct canvas *canvas = user;
    fprintf(canvas->file, "P6\n%u %u\n255\n", layer->width, layer->height);
    for (uint32_t y = 0; y < layer->height; y++) {
        const uint8_t *row = (const uint8_t *)layer->pixels + y * layer->row_bytes;
        for (uint32_t x = 0; x < layer->width; x++, row += layer->channels) {
            fwrite(row, 1, 3, canvas->file); /* red, green, blue; alpha is dropped */
            for (int c = 0; c < 3; c++)
                canvas->brightest = row[c] > canvas->brightest ? row[c] : canvas->brightest;
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: picture SCENE FRAME FILE.ppm\n");
        return KILN_USAGE;
    }
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene *scene = kiln_scene_load(argv[1], NULL, &error);
    struct kiln_device *device = scene ? kiln_device_open(NULL, &error) : NULL;

    const uint32_t number = (uint32_t)strtoul(argv[2], NULL, 10);
    const struct kiln_frame_range frame = {number, number};
    struct canvas canvas = {device ? fopen(argv[3], "wb") : NULL, 0};
    struct kiln_render_params params = kiln_render_defaults();
    params.ranges = &frame;
    params.range_count = 1;
    params.picture = take;
    params.user = &canvas;
    bool ok = canvas.file && kiln_render(device, scene, &params, NULL, &error);
    if (canvas.file)
        ok = fclose(canvas.file) == 0 && ok;

    if (ok)
        printf("frame %u, its brightest value is %u\n", number, canvas.brightest);
    else
        fprintf(stderr, "%s\n", *error.message ? error.message : argv[3]);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
    return ok ? 0 : error.code ? (int)error.code : KILN_IO;
}
