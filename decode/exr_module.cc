// This file is the module kiln-openexr.so: it decodes channels of an OpenEXR file by OpenEXR's C++
// library, which knows the compressions DWAA and DWAB and deep parts. kiln-decode opens the module
// only for files that its C core cannot decode, since the library takes milliseconds to load.
#include "exr_module.h"

#include <ImfChannelList.h>
#include <ImfCompositeDeepScanLine.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

namespace
{

// A file in memory.
class Bytes : public Imf::IStream
{
  public:
    Bytes(const unsigned char *content, size_t content_size)
        : Imf::IStream("an EXR image"), bytes(content), size(content_size), at(0)
    {
    }

    bool read(char target[], int count) override
    {
        if (count < 0 || at > size || (uint64_t)count > size - at)
            throw std::runtime_error("the file ends too early");
        std::memcpy(target, bytes + at, (size_t)count);
        at += (uint64_t)count;
        return at < size;
    }

    uint64_t tellg() override
    {
        return at;
    }
    void seekg(uint64_t place) override
    {
        at = place;
    }

  private:
    const unsigned char *bytes;
    uint64_t size, at;
};

// A missing alpha in the file is opaque, but such a channel is not asked for: the value is unused.
const double UNUSED = 0.0;

Imf::FrameBuffer targets_of(const kiln_openexr_request &request, const Imath::Box2i &window)
{
    Imf::FrameBuffer targets;
    for (const kiln_openexr_channel &channel : request.channels) {
        if (channel.name)
            targets.insert(channel.name,
                           Imf::Slice::Make(Imf::FLOAT, channel.first, window,
                                            channel.step * sizeof(float),
                                            channel.stride * sizeof(float), channel.sampling,
                                            channel.sampling, UNUSED));
    }
    return targets;
}

void read_pixels(const kiln_openexr_request &request)
{
    Bytes bytes(request.bytes, request.size);
    Imf::MultiPartInputFile file(bytes, 0, false);
    if (request.part < 0 || request.part >= file.parts())
        throw std::runtime_error("there is no such part");
    const Imath::Box2i window = file.header(request.part).dataWindow();
    const int32_t *known = request.data_window;
    // Memory was taken for the window that OpenEXR's C core had found.
    if (window.min.x != known[0] || window.min.y != known[1] || window.max.x != known[2] ||
        window.max.y != known[3])
        throw std::runtime_error("the data window is not clear");
    const Imf::FrameBuffer targets = targets_of(request, window);
    if (request.deep) {
        Imf::DeepScanLineInputPart part(file, request.part);
        Imf::CompositeDeepScanLine flat;
        flat.addSource(&part);
        flat.setFrameBuffer(targets);
        flat.readPixels(window.min.y, window.max.y);
    } else {
        Imf::InputPart part(file, request.part);
        part.setFrameBuffer(targets);
        part.readPixels(window.min.y, window.max.y);
    }
}

} // namespace

kiln_openexr_result kiln_openexr_read(const kiln_openexr_request *request, char *message,
                                      size_t message_size)
{
    try {
        read_pixels(*request);
        return KILN_OPENEXR_DONE;
    } catch (const std::bad_alloc &) {
        return KILN_OPENEXR_NO_MEMORY;
    } catch (const std::exception &fault) {
        std::snprintf(message, message_size, "%s", fault.what());
    } catch (...) {
        std::snprintf(message, message_size, "an unknown fault");
    }
    return KILN_OPENEXR_BROKEN;
}
