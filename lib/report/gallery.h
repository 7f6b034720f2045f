/* Plans and writes the pictures of a report page. Each picture is embedded in the page or linked.
 *
 * lib/report/html.c plans them before it writes the page, test_data.c asks where a frame's pictures
 * are, and html.c writes the embedded pictures last. The page's script finds a picture by its
 * number, so the id that kiln_gallery_write gives it must be the number of the plan. */
#ifndef KILN_REPORT_GALLERY_H
#define KILN_REPORT_GALLERY_H

#include "kiln_program.h"
#include "report/report.h"

/* The most bytes of pictures embedded in a page. A browser takes seconds and gigabytes for a page
 * with more. So a picture that would exceed this size is linked. The worst tests get their places
 * first.
 */
enum { KILN_GALLERY_BYTES = 160 << 20 };

enum kiln_gallery_role {
    KILN_GALLERY_REFERENCE,
    KILN_GALLERY_RESULT,
    KILN_GALLERY_ERROR_MAP,
    KILN_GALLERY_ROLE_COUNT
};

/* Where a picture is. */
struct kiln_gallery_place {
    enum kiln_gallery_kind {
        KILN_GALLERY_NONE,     /* there is no such picture */
        KILN_GALLERY_EMBEDDED, /* in the page, under its number */
        KILN_GALLERY_LINKED,   /* a path relative to the page's folder */
        KILN_GALLERY_BROKEN,   /* it cannot be shown; the text says why */
    } kind;
    uint32_t number;
    const char *text; /* LINKED: the path; BROKEN: the reason; it lives in the results' arena */
};

struct kiln_gallery;

/* Decides for every picture whether it is embedded or linked. `order` has the index of each test,
 * the most important test first; of a test, its worst frame comes first. When a picture that a
 * browser cannot show is linked, this writes a preview beside it. A result with the same bytes as
 * its reference shares its place. The gallery lives in results->arena. Returns NULL with
 * KILN_DEVICE_FAILED when memory is short. */
struct kiln_gallery *kiln_gallery_plan(const struct kiln_results *results, const size_t *order,
                                       const struct kiln_results_output *output,
                                       struct kiln_error *error);

/* Returns the places of a frame's pictures, KILN_GALLERY_ROLE_COUNT of them. */
const struct kiln_gallery_place *kiln_gallery_places(const struct kiln_gallery *gallery,
                                                     size_t test, size_t frame);

/* Return the number of embedded pictures, and of those that are linked because the page is full. */
uint32_t kiln_gallery_embedded_count(const struct kiln_gallery *gallery);
uint32_t kiln_gallery_linked_for_size(const struct kiln_gallery *gallery);

/* Writes the embedded pictures, each as a <script type="text/plain" id="pN"> in base64. The element
 * of a picture that cannot be read is empty and has the reason as its data-problem. One picture is
 * in memory at a time. */
void kiln_gallery_write(const struct kiln_gallery *gallery, FILE *out);

#endif
