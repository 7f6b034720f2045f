// This file is the module kiln-openexr.so: it decodes channels of an OpenEXR file by OpenEXR's C++
// library, which knows the compressions DWAA and DWAB and deep parts. kiln-decode opens the module
// only for files that its C core cannot decode, since the library takes milliseconds to load.
#include "exr_module.h"

#include <ImfChannelList.h>
#include <ImfCompositeDeepScanLine.h>
#include <ImfDeepFrameBuffer.h>
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
#include <vector>

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
    for (size_t i = 0; i < request.channel_count; i++) {
        const kiln_openexr_channel &channel = request.channels[i];
        const Imf::PixelType type = channel.whole ? Imf::UINT : Imf::FLOAT;
        targets.insert(channel.name,
                       Imf::Slice::Make(type, channel.first, window, channel.step * sizeof(float),
                                        channel.stride * sizeof(float), channel.sampling,
                                        channel.sampling, UNUSED));
    }
    return targets;
}

void flatten(const kiln_openexr_request &request, Imf::DeepScanLineInputPart &part,
             const Imath::Box2i &window)
{
    Imf::CompositeDeepScanLine flat;
    flat.addSource(&part);
    flat.setFrameBuffer(targets_of(request, window));
    flat.readPixels(window.min.y, window.max.y);
}

// A line of a deep part: the samples of each channel, pixel after pixel. Samples have four bytes,
// and those of Z are floats.
class DeepLine
{
  public:
    DeepLine(const kiln_openexr_request &wanted, Imf::DeepScanLineInputPart &source,
             const Imath::Box2i &data_window)
        : request(wanted), part(source), window(data_window),
          width((size_t)(window.max.x - window.min.x) + 1), counts(width),
          samples(wanted.channel_count + 1), places(wanted.channel_count + 1)
    {
        Imf::DeepFrameBuffer targets;
        const ptrdiff_t left = window.min.x;
        targets.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, (char *)(counts.data() - left), sizeof counts[0], 0));
        for (size_t i = 0; i <= request.channel_count; i++) {
            const bool depth = i == request.channel_count;
            const bool whole = !depth && request.channels[i].whole;
            places[i].resize(width);
            if (depth || std::strcmp(request.channels[i].name, "Z") != 0)
                targets.insert(depth ? "Z" : request.channels[i].name,
                               Imf::DeepSlice(whole ? Imf::UINT : Imf::FLOAT,
                                              (char *)(places[i].data() - left),
                                              sizeof places[i][0], 0, SAMPLE));
        }
        part.setFrameBuffer(targets);
    }

    void read(int y)
    {
        const size_t most = (size_t)1 << 26;
        size_t total = 0, used = 0;
        part.readPixelSampleCounts(y);
        for (unsigned count : counts)
            total += count;
        if (total > most)
            throw std::runtime_error("a line has more than 67108864 samples");
        for (size_t i = 0; i < samples.size(); i++, used = 0) {
            samples[i].resize(total * SAMPLE);
            for (size_t x = 0; x < width; used += counts[x++])
                places[i][x] = samples[i].data() + used * SAMPLE;
        }
        part.readPixels(y);
    }

    // Writes the nearest sample of each pixel to the line of the pictures.
    void put(size_t line) const
    {
        const size_t depth = request.channel_count;
        for (size_t x = 0; x < width; x++) {
            size_t nearest = 0;
            for (size_t i = 1; i < counts[x]; i++) {
                if (depth_of(x, i) < depth_of(x, nearest))
                    nearest = i;
            }
            for (size_t c = 0; c < request.channel_count && counts[x] > 0; c++) {
                const kiln_openexr_channel &channel = request.channels[c];
                const bool is_depth = std::strcmp(channel.name, "Z") == 0;
                std::memcpy((float *)channel.first + line * channel.stride + x * channel.step,
                            places[is_depth ? depth : c][x] + nearest * SAMPLE, SAMPLE);
            }
        }
    }

  private:
    static const size_t SAMPLE = 4;

    float depth_of(size_t x, size_t sample) const
    {
        float depth;
        std::memcpy(&depth, places[request.channel_count][x] + sample * SAMPLE, SAMPLE);
        return depth;
    }

    const kiln_openexr_request &request;
    Imf::DeepScanLineInputPart &part;
    const Imath::Box2i window;
    size_t width;
    std::vector<unsigned> counts;
    std::vector<std::vector<char>> samples; // of the channels, then of Z
    std::vector<std::vector<char *>> places;
};

void take_nearest(const kiln_openexr_request &request, Imf::DeepScanLineInputPart &part,
                  const Imath::Box2i &window)
{
    DeepLine line(request, part, window);
    for (int y = window.min.y; y <= window.max.y; y++) {
        line.read(y);
        line.put((size_t)(y - window.min.y));
    }
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
    if (request.deep == KILN_OPENEXR_NOT_DEEP) {
        Imf::InputPart part(file, request.part);
        part.setFrameBuffer(targets_of(request, window));
        part.readPixels(window.min.y, window.max.y);
        return;
    }
    Imf::DeepScanLineInputPart part(file, request.part);
    if (request.deep == KILN_OPENEXR_FLATTEN)
        flatten(request, part, window);
    else
        take_nearest(request, part, window);
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
