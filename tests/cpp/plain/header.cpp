// The header is clean C++11 and links as C.
#include <ricci/ricci.h>

#include <cstring>

int main() {
    ricci_control *control = nullptr;
    if (ricci_control_new(&control) != RICCI_OK) return 1;
    ricci_control_free(control);
    return std::strcmp(ricci_status_text(RICCI_OK), "done") != 0;
}
