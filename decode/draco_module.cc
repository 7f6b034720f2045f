// This file is the module kiln-draco.so: it decodes triangles that Draco compressed. kiln-decode
// opens the module only for files with such triangles, since the library takes milliseconds to
// load.
//
// Draco's own conversion of quantised numbers to floats rounds differently on different processors,
// so the library gives the integers, and this file computes the numbers in double.
#include "draco_module.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <exception>
#include <new>

namespace
{

// What turns the integers of an attribute into numbers.
class Scale
{
  public:
    explicit Scale(const draco::PointAttribute &attribute, double most_integer)
        : most(most_integer), kind(PLAIN)
    {
        const draco::AttributeTransformData *data = attribute.GetAttributeTransformData();
        if (!data)
            return;
        if (data->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM &&
            quantization.InitFromAttribute(attribute) && quantization.quantization_bits() > 0)
            kind = QUANTIZED;
        else if (data->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM &&
                 octahedron.InitFromAttribute(attribute) && octahedron.quantization_bits() > 1)
            kind = OCTAHEDRAL;
    }

    bool is_octahedral() const
    {
        return kind == OCTAHEDRAL;
    }

    double number(double value, int component) const
    {
        if (kind == QUANTIZED) {
            const double steps = (double)((1ull << quantization.quantization_bits()) - 1);
            return (double)quantization.min_value(component) +
                   value * ((double)quantization.range() / steps);
        }
        if (most > 0.0) {
            value /= most;
            value = value < -1.0 ? -1.0 : value;
        }
        return value;
    }

    // A unit vector by its place on an octahedron, whose faces unfold to a square.
    void vector(const int32_t place[2], double out[3]) const
    {
        const double most_place = (double)((1ull << octahedron.quantization_bits()) - 2);
        double y = place[0] * (2.0 / most_place) - 1.0, z = place[1] * (2.0 / most_place) - 1.0;
        double x = 1.0 - std::fabs(y) - std::fabs(z);
        const double fold = x < 0.0 ? -x : 0.0;
        y += y < 0.0 ? fold : -fold;
        z += z < 0.0 ? fold : -fold;
        const double length = std::sqrt(x * x + y * y + z * z);
        const bool good = length > 1e-6 && length < 1e6;
        out[0] = good ? x / length : 0.0;
        out[1] = good ? y / length : 0.0;
        out[2] = good ? z / length : 0.0;
    }

  private:
    enum Kind { PLAIN, QUANTIZED, OCTAHEDRAL };
    double most;
    Kind kind;
    draco::AttributeQuantizationTransform quantization;
    draco::AttributeOctahedronTransform octahedron;
};

enum { MOST_COMPONENTS = 4 };

bool read_value(const draco::PointAttribute &from, draco::AttributeValueIndex index,
                const Scale &scale, double out[MOST_COMPONENTS])
{
    if (scale.is_octahedral()) {
        int32_t place[2];
        if (!from.ConvertValue<int32_t, 2>(index, place))
            return false;
        scale.vector(place, out);
        return true;
    }
    double values[MOST_COMPONENTS] = {0.0, 0.0, 0.0, 0.0};
    if (!from.ConvertValue<double>(index, from.num_components(), values))
        return false;
    for (int c = 0; c < from.num_components(); c++)
        out[c] = scale.number(values[c], c);
    return true;
}

bool read_attribute(const draco::Mesh &mesh, kiln_draco_attribute *attribute)
{
    const draco::PointAttribute *from = mesh.GetAttributeByUniqueId(attribute->id);
    if (!from)
        return true;
    const Scale scale(*from, attribute->most);
    const uint32_t components = attribute->components;
    const int own = scale.is_octahedral() ? 3 : from->num_components();
    if (components > MOST_COMPONENTS || from->num_components() > MOST_COMPONENTS ||
        own < (int)components)
        return false;
    attribute->values = static_cast<float *>(
        std::malloc((size_t)mesh.num_points() * components * sizeof(float) + 1));
    if (!attribute->values)
        throw std::bad_alloc();
    for (uint32_t i = 0; i < mesh.num_points(); i++) {
        const draco::AttributeValueIndex index = from->mapped_index(draco::PointIndex(i));
        double value[MOST_COMPONENTS];
        if (index.value() >= from->size() || !read_value(*from, index, scale, value))
            return false;
        for (uint32_t c = 0; c < components; c++)
            attribute->values[(size_t)i * components + c] = (float)value[c];
    }
    return true;
}

bool read_triangles(const draco::Mesh &mesh, kiln_draco_request *request)
{
    request->triangles = static_cast<uint32_t(*)[3]>(
        std::malloc((size_t)mesh.num_faces() * sizeof *request->triangles + 1));
    if (!request->triangles)
        throw std::bad_alloc();
    for (uint32_t i = 0; i < mesh.num_faces(); i++) {
        const draco::Mesh::Face &face = mesh.face(draco::FaceIndex(i));
        for (size_t c = 0; c < 3; c++) {
            if (face[c].value() >= mesh.num_points())
                return false;
            request->triangles[i][c] = face[c].value();
        }
    }
    request->point_count = mesh.num_points();
    request->triangle_count = mesh.num_faces();
    return true;
}

kiln_draco_result read(kiln_draco_request *request, char *message, size_t message_size)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(request->bytes), request->size);
    draco::Decoder decoder;
    for (int type = 0; type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; type++)
        decoder.SetSkipAttributeTransform((draco::GeometryAttribute::Type)type);
    draco::StatusOr<std::unique_ptr<draco::Mesh>> result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) {
        std::snprintf(message, message_size, "%s", result.status().error_msg());
        return KILN_DRACO_BROKEN;
    }
    const draco::Mesh &mesh = *result.value();
    if (mesh.num_points() > request->most_points || mesh.num_faces() > request->most_triangles)
        return KILN_DRACO_TOO_LARGE;
    std::snprintf(message, message_size, "its numbers do not fit");
    if (!read_triangles(mesh, request))
        return KILN_DRACO_BROKEN;
    for (uint32_t i = 0; i < request->attribute_count; i++) {
        if (!read_attribute(mesh, &request->attributes[i]))
            return KILN_DRACO_BROKEN;
    }
    return KILN_DRACO_DONE;
}

} // namespace

kiln_draco_result kiln_draco_read(kiln_draco_request *request, char *message, size_t message_size)
{
    try {
        return read(request, message, message_size);
    } catch (const std::bad_alloc &) {
        return KILN_DRACO_NO_MEMORY;
    } catch (const std::exception &fault) {
        std::snprintf(message, message_size, "%s", fault.what());
    } catch (...) {
        std::snprintf(message, message_size, "an unknown fault");
    }
    return KILN_DRACO_BROKEN;
}
