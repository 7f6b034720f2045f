/* This file finds the schemas that a schema has in several places, such as the forces of systems,
 * of baked winds and of gas, and lets each stand once, as a definition that all places refer to.
 *
 * It works on the text, whose writers so need to know nothing of each other. Objects are compared
 * as they are written. The value of `properties` maps names to schemas, and is none itself. */
#include "option/schema_share.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A schema that is shorter stays in its places: a reference would take about as much. */
enum { LEAST_LENGTH = 100, MOST_DEPTH = 128, MOST_NAME = 40 };

/* Describes an object of the text. Objects are numbered in the order in which they begin. */
struct object {
    size_t begin, end;     /* of its text */
    uint32_t parent, next; /* next: of the first object behind it and all within it */
    uint32_t same;         /* the first object with the same text */
    uint32_t uses;         /* of the first: how often other texts have it */
    bool is_map;           /* of names to schemas */
    const char *key; /* that it is the value of: not ended by a zero; NULL: an item of a list */
    size_t key_length;
    uint32_t definition; /* number of its definition; 0: it has none so far */
};

struct sharing {
    const char *text;
    struct object *objects;
    uint32_t count, room;
    uint32_t *table; /* of first objects, by their texts; UINT32_MAX: free */
    uint32_t definitions;
    struct kiln_text *list; /* of the definitions */
};

/* ---- finding objects ------------------------------------------------------------------------- */

static bool is_word(const char *key, size_t length, const char *word)
{
    return key && strlen(word) == length && memcmp(key, word, length) == 0;
}

static bool add_object(struct sharing *s, size_t begin, uint32_t parent, const char *key,
                       size_t key_length)
{
    if (s->count == s->room) {
        const uint32_t room = s->room ? 2 * s->room : 1024;
        struct object *more = realloc(s->objects, room * sizeof *more);
        if (!more)
            return false;
        s->objects = more;
        s->room = room;
    }
    const bool maps =
        is_word(key, key_length, "properties") || is_word(key, key_length, "patternProperties");
    s->objects[s->count] = (struct object){
        .begin = begin,
        .parent = parent,
        .is_map = maps && s->count > 0 && !s->objects[parent].is_map,
        .key = key,
        .key_length = key_length,
    };
    s->count++;
    return true;
}

/* Returns the end of a string, behind its closing quote. */
static const char *string_end(const char *at)
{
    at++;
    while (*at != '"' && *at)
        at += *at == '\\' && at[1] ? 2 : 1;
    return *at ? at + 1 : at;
}

/* Lists the objects of the text. */
static bool find_objects(struct sharing *s)
{
    uint32_t open[MOST_DEPTH], depth = 0;
    const char *at = s->text, *key = NULL;
    size_t key_length = 0;
    while (*at) {
        if (*at == '"') {
            const char *end = string_end(at);
            if (*end == ':') {
                key = at + 1;
                key_length = (size_t)(end - at) - 2;
            }
            at = end;
            continue;
        }
        if (*at == '{') {
            if (depth == MOST_DEPTH)
                return false;
            open[depth] = s->count;
            if (!add_object(s, (size_t)(at - s->text), depth ? open[depth - 1] : 0, key,
                            key_length))
                return false;
            depth++;
        } else if (*at == '}') {
            if (depth == 0)
                return false;
            struct object *object = &s->objects[open[--depth]];
            object->end = (size_t)(at - s->text) + 1;
            object->next = s->count;
        }
        if (*at == '[' || *at == '{' || *at == ',')
            key = NULL;
        at++;
    }
    return depth == 0 && s->count > 0;
}

/* ---- finding those that are the same --------------------------------------------------------- */

static uint32_t hash_of(const char *text, size_t length)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 16777619u;
    return hash;
}

static bool is_same(const struct sharing *s, const struct object *a, const struct object *b)
{
    const size_t length = a->end - a->begin;
    return a->is_map == b->is_map && b->end - b->begin == length &&
           memcmp(s->text + a->begin, s->text + b->begin, length) == 0;
}

static bool find_same(struct sharing *s)
{
    uint32_t size = 16;
    while (size < 2 * s->count)
        size *= 2;
    s->table = malloc(size * sizeof *s->table);
    if (!s->table)
        return false;
    memset(s->table, 0xff, size * sizeof *s->table);
    for (uint32_t i = 0; i < s->count; i++) {
        struct object *object = &s->objects[i];
        uint32_t slot = hash_of(s->text + object->begin, object->end - object->begin) & (size - 1);
        while (s->table[slot] != UINT32_MAX && !is_same(s, &s->objects[s->table[slot]], object))
            slot = (slot + 1) & (size - 1);
        if (s->table[slot] == UINT32_MAX)
            s->table[slot] = i;
        object->same = s->table[slot];
    }
    /* what is within a copy stands in the text only where the first one does */
    for (uint32_t i = 1; i < s->count; i++)
        if (s->objects[s->objects[i].parent].same == s->objects[i].parent)
            s->objects[s->objects[i].same].uses++;
    return true;
}

/* ---- writing --------------------------------------------------------------------------------- */

static bool is_shared(const struct object *object)
{
    return !object->is_map && object->uses > 1 && object->end - object->begin >= LEAST_LENGTH;
}

static bool is_name(const struct object *object)
{
    bool good = object->key_length > 0 && object->key_length <= MOST_NAME;
    for (size_t i = 0; good && i < object->key_length; i++)
        good = (object->key[i] >= 'a' && object->key[i] <= 'z') || object->key[i] == '_';
    return good;
}

/* Appends the name of a definition: the nearest key of a property, and a number. */
static void add_name(const struct sharing *s, const struct object *object, struct kiln_text *out)
{
    const struct object *at = object;
    while (at != s->objects && !(s->objects[at->parent].is_map && at->key && is_name(at)))
        at = &s->objects[at->parent];
    if (at != s->objects)
        kiln_text_add(out, "%.*s_", (int)at->key_length, at->key);
    kiln_text_add(out, "%u", object->definition);
}

static void add_slice(const struct sharing *s, size_t begin, size_t end, struct kiln_text *out)
{
    kiln_text_add(out, "%.*s", (int)(end - begin), s->text + begin);
}

static void write_inside(struct sharing *s, uint32_t number, struct kiln_text *out);

/* Appends an object, or a reference to its definition, which it writes before the first one. */
static void write_object(struct sharing *s, uint32_t number, struct kiln_text *out)
{
    struct object *first = &s->objects[s->objects[number].same];
    if (!is_shared(first)) {
        write_inside(s, number, out);
        return;
    }
    if (first->definition == 0) {
        struct kiln_text definition = {0};
        first->definition = ++s->definitions;
        write_inside(s, s->objects[number].same, &definition);
        kiln_text_add(s->list, ",\n\"");
        add_name(s, first, s->list);
        kiln_text_add(s->list, "\": %s", definition.data ? definition.data : "");
        s->list->failed |= definition.failed;
        kiln_text_free(&definition);
    }
    kiln_text_add(out, "{\"$ref\": \"#/definitions/");
    add_name(s, first, out);
    kiln_text_add(out, "\"}");
}

/* Appends an object, whose own objects may become references. */
static void write_inside(struct sharing *s, uint32_t number, struct kiln_text *out)
{
    const struct object *object = &s->objects[number];
    size_t at = object->begin;
    for (uint32_t i = number + 1; i < object->next; i = s->objects[i].next) {
        add_slice(s, at, s->objects[i].begin, out);
        write_object(s, i, out);
        at = s->objects[i].end;
    }
    add_slice(s, at, object->end, out);
}

void kiln_schema_share(const char *schema, struct kiln_text *out, struct kiln_text *definitions)
{
    struct sharing s = {.text = schema, .list = definitions};
    if (find_objects(&s) && find_same(&s))
        write_inside(&s, 0, out);
    else
        out->failed = true;
    free(s.objects);
    free(s.table);
}
