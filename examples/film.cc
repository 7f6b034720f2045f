// film SCENE CLIP.mp4 [KEY=VALUE...]: renders a clip, from C++. Smart pointers own the scene and
// the device, and errors become exceptions; all else is plain kiln.h.
#include <cstdio>
#include <kiln.h>
#include <memory>
#include <stdexcept>
#include <vector>

namespace
{

struct Error : std::runtime_error {
    explicit Error(const kiln_error &error) : std::runtime_error(error.message), code(error.code)
    {
    }
    kiln_code code;
};

template <typename Thing, void (*destroy)(Thing **)> struct Destroy {
    void operator()(Thing *thing) const
    {
        destroy(&thing);
    }
};
using Scene = std::unique_ptr<kiln_scene, Destroy<kiln_scene, kiln_scene_destroy>>;
using Device = std::unique_ptr<kiln_device, Destroy<kiln_device, kiln_device_close>>;

Scene load(const char *path, const std::vector<const char *> &overrides)
{
    kiln_error error = kiln_error_empty();
    kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides.data();
    params.override_count = overrides.size();
    Scene scene(kiln_scene_load(path, &params, &error));
    return scene ? std::move(scene) : throw Error(error);
}

Device open_device()
{
    kiln_error error = kiln_error_empty();
    Device device(kiln_device_open(nullptr, &error));
    return device ? std::move(device) : throw Error(error);
}

kiln_render_stats render(const Device &device, const Scene &scene, const kiln_render_params &params)
{
    kiln_error error = kiln_error_empty();
    kiln_render_stats stats = kiln_render_stats_empty();
    return kiln_render(device.get(), scene.get(), &params, &stats, &error) ? stats
                                                                           : throw Error(error);
}

} // namespace

int main(int argc, char **argv)
try {
    if (argc < 3)
        return std::fputs("usage: film SCENE CLIP.mp4 [KEY=VALUE...]\n", stderr), KILN_USAGE;
    kiln_render_params params = kiln_render_defaults();
    params.output = argv[2];
    params.overwrite = true;
    const Scene scene = load(argv[1], {argv + 3, argv + argc});
    const kiln_render_stats stats = render(open_device(), scene, params);
    std::printf("%u frames in %.1f s\n", stats.frames, stats.total_s);
    return 0;
} catch (const Error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.code;
}
