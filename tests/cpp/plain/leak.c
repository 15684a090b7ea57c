/* A mesh that is never freed. valgrind has to report it, with the function of the library that made it:
 * this shows that valgrind would find leaks in the other programs. */
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
