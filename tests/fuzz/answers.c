/* Fuzzes how kiln reads the answers of kiln-decode, the separate process that decodes strangers'
 * files: kiln must take any bytes as a picture, video, mesh or skin within the limits, or report an
 * error. If this fails, a malicious file that has taken over kiln-decode can crash kiln or take
 * over kiln, too. kiln_feeder (feeder.c) runs in the place of kiln-decode and sends the bytes. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "asset/geometry/skin.h"
#include "asset/image/layers_in.h"
#include "asset/image/video_in.h"
#include "fuzz.h"
#include "image_check.h"
#include "mesh_check.h"

static char fed[64]; /* path of the file that holds the input; kiln_feeder sends it */
static char exr[64]; /* path of a file that begins as an EXR does */

static void begin(void)
{
    snprintf(fed, sizeof fed, "/tmp/kiln-fuzz-%d.mp4", (int)getpid());
    snprintf(exr, sizeof exr, "/tmp/kiln-fuzz-%d.exr", (int)getpid());
    setenv("KILN_FEED", fed, 1);
    setenv("KILN_LIBEXEC_DIR", KILN_FEEDER, 1);
}

static void write_file(const char *path, const void *data, size_t size)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    require(file >= 0 && write(file, data, size) == (ssize_t)size, "the file cannot be written");
    close(file);
}

static void read_layers(void)
{
    struct kiln_error error = {0};
    struct kiln_image_layer layer = {.image = NULL};
    write_file(exr, "v/1\x01", 4);
    struct kiln_layers_in *layers = kiln_layers_in_open(NULL, exr, NULL, &error);
    while (layers && kiln_layers_in_read(layers, &layer, &error) && layer.image) {
        require(*layer.name && memchr(layer.name, '\0', sizeof layer.name), "a layer has no name");
        require(layer.data || layer.image->type != KILN_IMAGE_U32, "colours are whole numbers");
        fuzz_taken = check_image(layer.image, &error) || fuzz_taken;
    }
    kiln_layers_in_close(&layers);
    unlink(exr);
}

static void read_video(void)
{
    struct kiln_error error = {0};
    struct kiln_video_in *video = kiln_video_in_open(NULL, fed, &error);
    struct kiln_asset_image *image = NULL;
    while (video && kiln_video_in_read(video, &image, &error) && image)
        fuzz_taken = check_image(image, &error);
    kiln_video_in_close(&video);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char png[] = "\x89PNG\r\n\x1a\n";
    struct kiln_error error = {0};
    if (!*fed)
        begin();
    write_file(fed, data, size);
    fuzz_taken = check_image(kiln_asset_image_parse(png, sizeof png, "fuzz.png", &error), &error);
    read_video();
    read_layers();
    struct kiln_mesh *mesh = kiln_mesh_parse("v", 1, "fuzz.obj", &error);
    if (mesh)
        check_mesh(mesh);
    fuzz_taken = fuzz_taken || mesh;
    kiln_mesh_destroy(&mesh);
    mesh = kiln_mesh_parse_with_materials("v", 1, "fuzz.obj", &error);
    if (mesh)
        check_looks(mesh);
    fuzz_taken = fuzz_taken || mesh;
    kiln_mesh_destroy(&mesh);
    struct kiln_skin *skin = kiln_skin_parse("{", 1, "fuzz.gltf", &error);
    if (skin)
        check_skin(skin);
    fuzz_taken = fuzz_taken || skin;
    kiln_skin_destroy(&skin);
    struct kiln_rig *rig = kiln_rig_parse("{", 1, "fuzz.gltf", &error);
    if (rig)
        check_rig(rig);
    fuzz_taken = fuzz_taken || rig;
    kiln_rig_destroy(&rig);
    unlink(fed);
    return 0;
}
