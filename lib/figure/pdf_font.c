/* Makes a TrueType font of empty glyphs with the widths of the lettering, and the objects by which
 * a PDF uses it. In the PDF's texts a character is two bytes, its code in Unicode. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "figure/font.h"
#include "figure/pdf.h"

enum {
    CODES = 0x10000,
    UNITS_PER_EM = 10 * KILN_FONT_EM, /* a unit of the stroke font is ten of this font */
    MOST_IN_BLOCK = 100, /* entries in a block of the map to Unicode, which PDF limits */
};

/* The characters of a drawing, in ascending order. */
struct characters {
    uint16_t *codes;
    size_t count;
};

static bool list_characters(const struct kiln_drawing *drawing, struct characters *characters)
{
    bool *used = calloc(CODES, sizeof *used);
    characters->codes = calloc(CODES, sizeof *characters->codes);
    characters->count = 0;
    bool ok = used && characters->codes;
    for (size_t i = 0; ok && i < drawing->count; i++) {
        const char *text = drawing->marks[i].text;
        uint32_t code;
        while (drawing->marks[i].kind == KILN_MARK_TEXT && (code = kiln_font_next(&text)) != 0)
            used[code % CODES] = true;
    }
    for (uint32_t code = 0; ok && code < CODES; code++) {
        if (used[code])
            characters->codes[characters->count++] = (uint16_t)code;
    }
    free(used);
    return ok;
}

/* ---- TrueType ------------------------------------------------------------------------------- */

static void put16(FILE *out, uint32_t value)
{
    fputc((int)(value >> 8 & 255), out);
    fputc((int)(value & 255), out);
}

static void put32(FILE *out, uint32_t value)
{
    put16(out, value >> 16);
    put16(out, value);
}

static void put_zeros(FILE *out, int count)
{
    for (int i = 0; i < count; i++)
        fputc(0, out);
}

static void put_head(FILE *out)
{
    put32(out, 0x00010000); /* version */
    put32(out, 0x00010000); /* revision of the font */
    put32(out, 0);          /* checksum of the file, which readers of PDF ignore */
    put32(out, 0x5F0F3CF5);
    put16(out, 0);
    put16(out, UNITS_PER_EM);
    put_zeros(out, 16 + 8); /* dates, bounding box */
    put16(out, 0);          /* style */
    put16(out, 8);          /* smallest size in pixels */
    put16(out, 2);          /* from left to right */
    put16(out, 0);          /* short offsets */
    put16(out, 0);
}

static void put_hhea(FILE *out, size_t glyphs)
{
    put32(out, 0x00010000);
    put16(out, KILN_FONT_ASCENT * 10);
    put16(out, (uint32_t)-KILN_FONT_DESCENT * 10);
    put_zeros(out, 2 + 2 + 2 + 2 + 2); /* line gap, greatest width and bearings */
    put16(out, 1);                     /* upright */
    put_zeros(out, 2 + 2 + 8 + 2);
    put16(out, (uint32_t)glyphs);
}

static void put_maxp(FILE *out, size_t glyphs)
{
    put32(out, 0x00010000);
    put16(out, (uint32_t)glyphs);
    put_zeros(out, 8);
    put16(out, 2); /* zones */
    put_zeros(out, 16);
}

/* Writes the widths of the glyphs. Glyph 0 stands for missing characters. */
static void put_hmtx(FILE *out, const struct characters *characters)
{
    put32(out, 0);
    for (size_t i = 0; i < characters->count; i++) {
        put16(out, kiln_font_advance(characters->codes[i]) * 10);
        put16(out, 0);
    }
}

static uint32_t sum_of(const uint8_t *bytes, size_t size)
{
    uint32_t sum = 0;
    for (size_t i = 0; i < size; i++)
        sum += (uint32_t)bytes[i] << (24 - 8 * (i % 4));
    return sum;
}

/* Appends a table to the data and its row to the directory. */
static void add_table(FILE *directory, FILE *data, const char *tag, uint8_t *bytes, size_t size,
                      uint32_t *offset)
{
    fwrite(tag, 1, 4, directory);
    put32(directory, sum_of(bytes, size));
    put32(directory, *offset);
    put32(directory, (uint32_t)size);
    int padding = (int)(-size % 4);
    fwrite(bytes, 1, size, data);
    put_zeros(data, padding);
    *offset += (uint32_t)size + (uint32_t)padding;
}

enum { GLYF, HEAD, HHEA, HMTX, LOCA, MAXP, TABLES };

static void put_table(FILE *out, int table, const struct characters *characters)
{
    size_t glyphs = characters->count + 1;
    if (table == GLYF)
        put32(out, 0); /* no outlines, but readers want a table that is not empty */
    else if (table == HEAD)
        put_head(out);
    else if (table == HHEA)
        put_hhea(out, glyphs);
    else if (table == HMTX)
        put_hmtx(out, characters);
    else if (table == LOCA)
        put_zeros(out, (int)(glyphs + 1) * 2);
    else
        put_maxp(out, glyphs);
}

/* Makes the bytes of the font, which the caller frees. */
static bool make_font(const struct characters *characters, char **bytes, size_t *size)
{
    static const char *const tags[TABLES] = {"glyf", "head", "hhea", "hmtx", "loca", "maxp"};
    char *body = NULL;
    size_t body_size = 0;
    uint32_t offset = 12 + 16 * TABLES;
    FILE *out = open_memstream(bytes, size), *data = open_memstream(&body, &body_size);
    bool ok = out && data;
    if (ok) {
        put32(out, 0x00010000);
        put16(out, TABLES);
        put16(out, 64); /* search range (4 * 16), its logarithm, and the rest: for a binary search
                           of the tables */
        put16(out, 2);
        put16(out, TABLES * 16 - 64);
    }
    for (int i = 0; ok && i < TABLES; i++) {
        char *table = NULL;
        size_t table_size = 0;
        FILE *one = open_memstream(&table, &table_size);
        if (one)
            put_table(one, i, characters);
        ok = one && fclose(one) == 0;
        if (ok)
            add_table(out, data, tags[i], (uint8_t *)table, table_size, &offset);
        free(table);
    }
    ok = data && fclose(data) == 0 && ok;
    if (ok)
        fwrite(body, 1, body_size, out);
    ok = out && fclose(out) == 0 && ok;
    free(body);
    return ok;
}

/* ---- Objects -------------------------------------------------------------------------------- */

/* Writes the map from characters to glyphs: two bytes for each code up to the largest one. */
static bool put_glyph_map(struct kiln_pdf *pdf, const struct characters *characters)
{
    size_t size =
        characters->count ? 2 * ((size_t)characters->codes[characters->count - 1] + 1) : 2;
    uint8_t *map = calloc(size, 1);
    for (size_t i = 0; map && i < characters->count; i++) {
        uint8_t *glyph = map + 2 * (size_t)characters->codes[i];
        glyph[0] = (uint8_t)((i + 1) >> 8);
        glyph[1] = (uint8_t)(i + 1);
    }
    bool ok = map && kiln_pdf_stream(pdf, "", map, size);
    free(map);
    return ok;
}

static bool put_unicode_map(struct kiln_pdf *pdf, const struct characters *characters)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return false;
    fputs("/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n"
          "/CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) /Supplement 0 >> def\n"
          "/CMapName /Adobe-Identity-UCS def\n/CMapType 2 def\n"
          "1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n",
          out);
    for (size_t i = 0; i < characters->count; i++) {
        size_t left = characters->count - i;
        if (i % MOST_IN_BLOCK == 0)
            fprintf(out, "%zu beginbfchar\n", left < MOST_IN_BLOCK ? left : MOST_IN_BLOCK);
        fprintf(out, "<%04X> <%04X>\n", characters->codes[i], characters->codes[i]);
        if (i % MOST_IN_BLOCK == MOST_IN_BLOCK - 1 || left == 1)
            fputs("endbfchar\n", out);
    }
    fputs("endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n", out);
    bool ok = fclose(out) == 0 && kiln_pdf_stream(pdf, "", text, size);
    free(text);
    return ok;
}

/* Writes the widths of characters in thousandths of the em. */
static void put_widths(FILE *out, const struct characters *characters)
{
    fputs("/W [", out);
    for (size_t i = 0; i < characters->count; i++)
        fprintf(out, " %u [%.3f]", characters->codes[i],
                kiln_font_advance(characters->codes[i]) * 1000.0 / KILN_FONT_EM);
    fputs(" ]\n", out);
}

static void put_dictionaries(struct kiln_pdf *pdf, const struct characters *characters)
{
    static const char *const name = "/KILNAA+KilnLettering";
    const double em = 1000.0 / KILN_FONT_EM;
    FILE *out = pdf->out;
    size_t first = pdf->objects + 1;
    kiln_pdf_begin(pdf);
    fprintf(out,
            "<< /Type /Font /Subtype /Type0 /BaseFont %s /Encoding /Identity-H\n"
            "/DescendantFonts [%zu 0 R] /ToUnicode %zu 0 R >>\nendobj\n",
            name, first + 1, first + 5);
    kiln_pdf_begin(pdf);
    fprintf(out,
            "<< /Type /Font /Subtype /CIDFontType2 /BaseFont %s\n"
            "/CIDSystemInfo << /Registry (Adobe) /Ordering (Identity) /Supplement 0 >>\n"
            "/FontDescriptor %zu 0 R /CIDToGIDMap %zu 0 R\n",
            name, first + 2, first + 4);
    put_widths(out, characters);
    fputs(">>\nendobj\n", out);
    kiln_pdf_begin(pdf);
    fprintf(out,
            "<< /Type /FontDescriptor /FontName %s /Flags 4 /FontBBox [0 %.0f 1000 %.0f]\n"
            "/ItalicAngle 0 /Ascent %.0f /Descent %.0f /CapHeight %.0f /StemV %.0f\n"
            "/FontFile2 %zu 0 R >>\nendobj\n",
            name, -KILN_FONT_DESCENT * em, KILN_FONT_ASCENT * em, KILN_FONT_ASCENT * em,
            -KILN_FONT_DESCENT * em, KILN_FONT_CAPITAL * em, KILN_FONT_PEN * em, first + 3);
}

bool kiln_pdf_font(struct kiln_pdf *pdf)
{
    struct characters characters;
    char *font = NULL;
    size_t size = 0;
    bool ok = list_characters(pdf->drawing, &characters) && make_font(&characters, &font, &size);
    if (ok) {
        char entries[40];
        put_dictionaries(pdf, &characters);
        snprintf(entries, sizeof entries, "/Length1 %zu ", size);
        ok = kiln_pdf_stream(pdf, entries, font, size) && put_glyph_map(pdf, &characters) &&
             put_unicode_map(pdf, &characters);
    }
    free(font);
    free(characters.codes);
    return ok;
}
