/* Reads the identifier of this build: the note NT_GNU_BUILD_ID, which `ld --build-id` writes, in
 * the loaded object (program or shared library) that this function is part of. */
#include "base/build_id.h"

#include <elf.h>
#include <link.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

struct search {
    uintptr_t code; /* an address in the object that is looked for */
    char *hex;
    bool found;
};

static bool contains(const struct dl_phdr_info *object, uintptr_t address)
{
    for (size_t i = 0; i < object->dlpi_phnum; i++) {
        const ElfW(Phdr) *segment = &object->dlpi_phdr[i];
        if (segment->p_type == PT_LOAD &&
            address - (object->dlpi_addr + segment->p_vaddr) < segment->p_memsz)
            return true;
    }
    return false;
}

static size_t aligned(size_t size)
{
    return (size + 3) & ~(size_t)3;
}

static bool read_notes(const unsigned char *notes, size_t size, char *hex)
{
    ElfW(Nhdr) note;
    while (size >= sizeof note) {
        memcpy(&note, notes, sizeof note);
        const size_t name = sizeof note, text = name + aligned(note.n_namesz);
        const size_t end = text + aligned(note.n_descsz);
        if (end > size)
            return false;
        if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof "GNU" &&
            memcmp(notes + name, "GNU", sizeof "GNU") == 0 && note.n_descsz >= 8 &&
            note.n_descsz <= (KILN_BUILD_ID_SIZE - 1) / 2) {
            for (size_t i = 0; i < note.n_descsz; i++)
                snprintf(hex + 2 * i, 3, "%02x", notes[text + i]);
            return true;
        }
        notes += end;
        size -= end;
    }
    return false;
}

static int look(struct dl_phdr_info *object, size_t size, void *user)
{
    (void)size;
    struct search *search = user;
    if (!contains(object, search->code))
        return 0;
    for (size_t i = 0; i < object->dlpi_phnum && !search->found; i++) {
        const ElfW(Phdr) *segment = &object->dlpi_phdr[i];
        const uintptr_t notes = object->dlpi_addr + segment->p_vaddr;
        if (segment->p_type == PT_NOTE) {
            /* NOLINTNEXTLINE(performance-no-int-to-ptr): ELF has addresses as numbers */
            const unsigned char *bytes = (const unsigned char *)notes;
            search->found = read_notes(bytes, segment->p_memsz, search->hex);
        }
    }
    return 1;
}

bool kiln_build_id(char hex[KILN_BUILD_ID_SIZE])
{
    struct search search = {.code = (uintptr_t)&kiln_build_id, .hex = hex};
    dl_iterate_phdr(look, &search);
    return search.found;
}
