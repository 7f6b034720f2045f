/* This file converts pictures by profiles with tables, by lcms2. Its numbers are those of floats
 * and of the processor's vectors: they may differ by a level from machine to machine. */
#include <lcms2.h>

#include "base/error.h"
#include "base/library.h"
#include "decode.h"

#define PROFILE_FUNCTIONS(F)                                                                       \
    F(cmsSetLogErrorHandler)                                                                       \
    F(cmsOpenProfileFromMem)                                                                       \
    F(cmsCreate_sRGBProfile)                                                                       \
    F(cmsCreateTransform)                                                                          \
    F(cmsDoTransform)                                                                              \
    F(cmsDeleteTransform)                                                                          \
    F(cmsCloseProfile)

static struct {
    PROFILE_FUNCTIONS(KILN_LIBRARY_POINTER)
} lcms;

static void on_error(cmsContext context, cmsUInt32Number code, const char *text)
{
    (void)context;
    (void)code;
    (void)text;
}

bool decode_profile_begin(struct kiln_error *error)
{
#define FIND(function) {#function, &lcms.function},
    static const struct kiln_library_function functions[] = {PROFILE_FUNCTIONS(FIND)};
#undef FIND
    if (!kiln_library_open("liblcms2.so.2", "liblcms2-2", functions,
                           sizeof functions / sizeof *functions, error))
        return false;
    lcms.cmsSetLogErrorHandler(on_error);
    return true;
}

/* Returns lcms2's name of the pixels' layout. Alpha and unused channels are `extra`: a conversion
 * in place leaves them as they are. */
static cmsUInt32Number layout_of(const struct kiln_asset_image *image, bool ink)
{
    const cmsUInt32Number bytes = image->type == KILN_IMAGE_U16 ? 2 : 1;
    if (ink)
        return bytes == 2 ? TYPE_CMYK_16_REV : TYPE_CMYK_8_REV;
    if (image->channels < 3)
        return COLORSPACE_SH(PT_GRAY) | CHANNELS_SH(1) | EXTRA_SH(3) | BYTES_SH(bytes);
    return COLORSPACE_SH(PT_RGB) | CHANNELS_SH(3) | EXTRA_SH(1) | BYTES_SH(bytes);
}

bool decode_profile_is_ready(void)
{
    return lcms.cmsDoTransform != NULL;
}

bool decode_profile_convert(struct kiln_asset_image *image, const struct decode_meaning *meaning)
{
    const cmsUInt32Number bytes = image->type == KILN_IMAGE_U16 ? 2 : 1;
    const cmsUInt32Number to =
        COLORSPACE_SH(PT_RGB) | CHANNELS_SH(3) | EXTRA_SH(1) | BYTES_SH(bytes);
    cmsHPROFILE profile =
        lcms.cmsOpenProfileFromMem(meaning->profile, (cmsUInt32Number)meaning->profile_size);
    cmsHPROFILE srgb = lcms.cmsCreate_sRGBProfile();
    cmsHTRANSFORM transform =
        profile && srgb ? lcms.cmsCreateTransform(profile, layout_of(image, meaning->ink), srgb, to,
                                                  INTENT_RELATIVE_COLORIMETRIC, 0)
                        : NULL;
    if (transform) {
        const size_t stride = kiln_asset_image_bytes(image) / image->height;
        for (uint32_t y = 0; y < image->height; y++) {
            uint8_t *row = (uint8_t *)image->pixels + y * stride;
            lcms.cmsDoTransform(transform, row, row, image->width);
        }
        lcms.cmsDeleteTransform(transform);
    }
    if (srgb)
        lcms.cmsCloseProfile(srgb);
    if (profile)
        lcms.cmsCloseProfile(profile);
    return transform != NULL;
}
