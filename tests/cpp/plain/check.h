/* Checks of the plain C tests: the first one that fails ends the program with 1. */
#ifndef CHECK_H
#define CHECK_H

#include <ricci/ricci.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_failed(const char *file, int line, const char *what) {
    fprintf(stderr, "%s:%d: %s (last error: %s)\n", file, line, what, ricci_last_error());
    exit(1);
}
#define CHECK(condition) ((condition) ? (void)0 : check_failed(__FILE__, __LINE__, #condition))
#define OK(call) CHECK((call) == RICCI_OK)
/* The call fails with this status, and its message has this word. */
#define FAILS(call, status, word) CHECK((call) == (status) && strstr(ricci_last_error(), (word)) != NULL)

#endif
