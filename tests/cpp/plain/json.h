/* The JSON of tests/vectors: objects, lists, whole numbers, and strings without escapes but in prose; numbers
 * with digits are strings of hexadecimal doubles. Memory is kept until json_forget. */
#ifndef JSON_H
#define JSON_H

#include "check.h"
#include <stdint.h>

typedef struct kept {
    struct kept *next;
} kept;
static kept *all_kept;

/* Memory for n entries, zeroed, until json_forget. */
static inline void *keep(size_t n, size_t size) {
    kept *p = (kept *)calloc(1, sizeof(kept) + 8 + n * size);
    CHECK(p);
    p->next = all_kept, all_kept = p;
    return p + 1;
}

static inline void json_forget(void) {
    while (all_kept) {
        kept *p = all_kept;
        all_kept = p->next;
        free(p);
    }
}

/* A value; `kind` is its first character: { [ " or a digit. */
typedef struct json {
    char kind;
    /* The name, if this is a member of an object. */
    const char *key;
    /* The text of a string or number. */
    const char *text;
    struct json *first, *next;
    size_t n;
} json;

static inline const char *json_blank(const char *at) {
    while (*at == ' ' || *at == '\n' || *at == ',' || *at == ':') at++;
    return at;
}

static inline char *json_copy(const char *from, const char *to) {
    char *text = (char *)keep((size_t)(to - from) + 1, 1);
    memcpy(text, from, (size_t)(to - from));
    return text;
}

/* The end of a string that begins behind its quote. */
static inline const char *json_quote(const char *at) {
    for (; *at != '"'; at++) {
        CHECK(*at);
        if (*at == '\\') at++;
    }
    return at;
}

/* Reads a value and goes behind it. */
static inline json *json_value(const char **at) {
    json *made = (json *)keep(1, sizeof *made);
    const char *p = json_blank(*at), *end;
    made->kind = *p;
    if (*p == '{' || *p == '[') {
        json **last = &made->first;
        for (p = json_blank(p + 1); *p != '}' && *p != ']'; p = json_blank(p)) {
            char *key = NULL;
            CHECK(*p);
            if (made->kind == '{') {
                end = json_quote(p + 1);
                key = json_copy(p + 1, end), p = end + 1;
            }
            *last = json_value(&p);
            (*last)->key = key, last = &(*last)->next, made->n++;
        }
        *at = p + 1;
    } else if (*p == '"') {
        end = json_quote(p + 1);
        made->text = json_copy(p + 1, end), *at = end + 1;
    } else {
        for (end = p; *end && strchr("+-.0123456789eE", *end); end++) {
        }
        CHECK(end > p);
        made->text = json_copy(p, end), *at = end;
    }
    return made;
}

/* A member of an object; NULL where it has none of this name. */
static inline const json *member(const json *object, const char *key) {
    for (const json *m = object->first; m; m = m->next)
        if (strcmp(m->key, key) == 0) return m;
    return NULL;
}

/* A member that there must be. */
static inline const json *need(const json *object, const char *key) {
    const json *m = member(object, key);
    if (!m) fprintf(stderr, "no %s\n", key);
    CHECK(m);
    return m;
}

static inline double number(const json *value) { return strtod(value->text, NULL); }
static inline size_t whole(const json *value) { return (size_t)strtoul(value->text, NULL, 10); }
static inline int is(const json *value, const char *text) { return value && strcmp(value->text, text) == 0; }

static inline double *numbers(const json *list) {
    double *x = (double *)keep(list->n, sizeof *x), *to = x;
    for (const json *m = list->first; m; m = m->next) *to++ = number(m);
    return x;
}

static inline uint32_t *indices(const json *list) {
    uint32_t *x = (uint32_t *)keep(list->n, sizeof *x), *to = x;
    for (const json *m = list->first; m; m = m->next) *to++ = (uint32_t)whole(m);
    return x;
}

static inline int32_t *signed_indices(const json *list) {
    int32_t *x = (int32_t *)keep(list->n, sizeof *x), *to = x;
    for (const json *m = list->first; m; m = m->next) *to++ = (int32_t)strtol(m->text, NULL, 10);
    return x;
}

#endif
