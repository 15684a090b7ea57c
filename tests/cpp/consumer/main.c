/* The header and the library that runs are of one version. */
#include <ricci/ricci.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    char header[32];
    snprintf(header, sizeof header, "%d.%d.%d", RICCI_VERSION_MAJOR, RICCI_VERSION_MINOR,
             RICCI_VERSION_PATCH);
    printf("header %s, library %s\n", header, ricci_version());
    return strcmp(header, ricci_version()) != 0;
}
