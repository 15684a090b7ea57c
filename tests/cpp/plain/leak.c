/* A mesh that is never freed. valgrind has to say so, and to name the function of the library that made it:
 * its verdict on the other programs is worth no more than that. */
#include "torus.h"

static ricci_mesh *make(void) {
    torus t = torus_new(4, 3);
    ricci_mesh *mesh = torus_mesh(&t);
    torus_free(&t);
    return mesh;
}

int main(void) {
    CHECK(make() != NULL);
    return 0;
}
