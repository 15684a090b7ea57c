/* Memory that the system refuses is RICCI_NO_MEMORY, and nothing is changed: every allocation of one job is
 * made to fail in turn, and all that follow until a large block is given back; then jobs run under limits of
 * the address space. Usage: test_memory [STRIDE]: every STRIDE-th allocation only.
 */
#define _GNU_SOURCE
#include "torus.h"
#include <errno.h>
#include <malloc.h>
#include <ricci/bicubic.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t n, size_t size);
extern void *__libc_realloc(void *p, size_t size);
extern void *__libc_memalign(size_t align, size_t size);
extern void __libc_free(void *p);

/* Blocks of this size and more end a shortage. */
enum { LARGE = 200000 };
static atomic_long count, first_refused;
static atomic_int armed, relieved;

/* Rust's own threads take up to 48 bytes from the system beside every allocator: of these the header warns.
 */
enum { THREAD_HANDLE = 48 };

static int refused(size_t size) {
    if (!armed || size <= THREAD_HANDLE) return 0;
    return ++count >= first_refused && !relieved;
}

void *malloc(size_t size) { return refused(size) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) { return refused(n * size) ? NULL : __libc_calloc(n, size); }
void *realloc(void *p, size_t size) { return refused(size) ? NULL : __libc_realloc(p, size); }
void *memalign(size_t align, size_t size) { return refused(size) ? NULL : __libc_memalign(align, size); }
void *aligned_alloc(size_t align, size_t size) { return memalign(align, size); }
int posix_memalign(void **place, size_t align, size_t size) {
    void *p = memalign(align, size);
    if (p) *place = p;
    return p ? 0 : ENOMEM;
}
static void given_back(size_t size) {
    if (armed && count >= first_refused && size >= LARGE) relieved = 1;
}
void free(void *p) {
    if (p) given_back(malloc_usable_size(p));
    __libc_free(p);
}
void *mmap(void *near, size_t size, int allow, int how, int file, off_t at) {
    return refused(size) ? MAP_FAILED : (void *)syscall(SYS_mmap, near, size, allow, how, file, at);
}
int munmap(void *p, size_t size) {
    given_back(size);
    return (int)syscall(SYS_munmap, p, size);
}

static int refusals;
enum { SPLINE_PLACES = 25 };

/* The answer of a call in a shortage; after RICCI_NO_MEMORY memory is there again, and so is what the call
 * needs. */
static ricci_status answer(ricci_status status) {
    CHECK(status == RICCI_OK || status == RICCI_NO_MEMORY);
    if (status == RICCI_OK) return status;
    ricci_failure failure;
    armed = 0;
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.status == RICCI_NO_MEMORY);
    refusals++;
    return status;
}
#define MUST(call)                                                                                           \
    do {                                                                                                     \
        if (answer(call) != RICCI_OK) OK(call);                                                              \
    } while (0)

/* From arrays to texture coordinates, each call again if it was refused. */
static void job(const torus *t, double *uv) {
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_map *map = NULL;
    ricci_flow_options options;
    ricci_layout_options laid;
    INIT(options), INIT(laid);
    options.threads = 1, laid.threads = 1;
    MUST(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, t->n_faces, &mesh));
    MUST(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    MUST(ricci_flow(metric, NULL, &options, NULL, &flat));
    MUST(ricci_layout_new(flat, &laid, NULL, &layout));
    MUST(ricci_map_new(flat, NULL, &map));
    MUST(ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 6 * t->n_faces));
    ricci_map_free(map), ricci_layout_free(layout);
    ricci_metric_free(flat), ricci_metric_free(metric), ricci_mesh_free(mesh);
}

/* The k-th allocation from now on begins a shortage. */
static void shortage_from(long k) {
    first_refused = k;
    count = 0;
    relieved = 0;
    armed = 1;
}

/* From a polygon to points of a fitted spline, whose text is read back. */
static void spline_job(const torus *t, double *values) {
    const double corners[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const size_t starts[2] = {0, 4};
    ricci_mesh *domain = NULL;
    ricci_spline *flat = NULL, *fitted = NULL, *parsed = NULL;
    ricci_spline_spec spec;
    ricci_spline_fit_options options;
    ricci_spline_places places;
    size_t n = 0;
    (void)t;
    INIT(spec), INIT(options), INIT(places);
    double points[3 * SPLINE_PLACES], parameters[2 * SPLINE_PLACES];
    for (int i = 0; i < SPLINE_PLACES; i++) {
        const double x = 0.1 + 0.2 * (i % 5), y = 0.1 + 0.2 * (i / 5); /* NOLINT: rows */
        points[3 * i] = parameters[2 * i] = x, points[3 * i + 1] = parameters[2 * i + 1] = y;
        points[3 * i + 2] = x * y;
    }
    spec.degree = 2, options.threads = 1, options.fairness = 1e-6;
    places.parameters = parameters, places.n = SPLINE_PLACES, places.threads = 1;
    MUST(ricci_spline_domain(corners, starts, 1, 0.8, &domain));
    MUST(ricci_spline_new(domain, &spec, &flat));
    MUST(ricci_spline_fit(flat, points, SPLINE_PLACES, &options, NULL, &fitted));
    MUST(ricci_spline_text(fitted, NULL, 0, &n));
    char *text = (char *)__libc_malloc(n);
    MUST(ricci_spline_text(fitted, text, n, &n));
    MUST(ricci_spline_parse(text, &parsed));
    MUST(ricci_spline_evaluate(parsed, &places, RICCI_SPLINE_POINT, NULL, values, 3 * SPLINE_PLACES));
    __libc_free(text);
    ricci_spline_free(parsed), ricci_spline_free(fitted), ricci_spline_free(flat);
    ricci_mesh_free(domain);
}

/* From a polygon to the end of a STEP file. */
static void patches_job(const torus *t, double *values) {
    const double corners[6] = {0, 0, 1, 0, 0, 1};
    const size_t starts[2] = {0, 3};
    ricci_mesh *domain = NULL;
    ricci_spline *flat = NULL;
    ricci_bicubic *patches = NULL;
    ricci_spline_spec spec;
    ricci_bicubic_options options;
    size_t n = 0;
    (void)t;
    INIT(spec), INIT(options);
    spec.degree = 1, options.threads = 1, options.tolerance = 0.1;
    MUST(ricci_spline_domain(corners, starts, 1, 2, &domain));
    MUST(ricci_spline_new(domain, &spec, &flat));
    MUST(ricci_bicubic_new(flat, &options, NULL, &patches));
    MUST(ricci_bicubic_text(patches, RICCI_BICUBIC_STEP, NULL, NULL, 0, &n));
    char *text = (char *)__libc_malloc(n);
    MUST(ricci_bicubic_text(patches, RICCI_BICUBIC_STEP, NULL, text, n, &n));
    const size_t compared = 3 * SPLINE_PLACES * sizeof *values;
    memcpy(values, text + n - compared, compared);
    __libc_free(text);
    ricci_bicubic_free(patches), ricci_spline_free(flat), ricci_mesh_free(domain);
}

static void every_allocation_fails_in_turn(void (*run)(const torus *, double *), const char *name,
                                           long stride) {
    torus t = torus_new(7, 5);
    const size_t bytes = 6 * t.n_faces * sizeof(double);
    double *expected = (double *)room(6 * t.n_faces, sizeof *expected);
    double *found = (double *)room(6 * t.n_faces, sizeof *found);
    CHECK(6 * t.n_faces >= 3 * SPLINE_PLACES);
    run(&t, expected);
    shortage_from(1L << 60);
    run(&t, found);
    armed = 0;
    const long n = count;
    const int before = refusals;
    CHECK(n > 300 && memcmp(found, expected, bytes) == 0);
    for (long k = 1; k <= n; k += stride) {
        memset(found, 0, bytes);
        shortage_from(k);
        run(&t, found);
        armed = 0;
        CHECK(memcmp(found, expected, bytes) == 0);
    }
    printf("%s: %ld allocations were refused in turn; %d calls answered that there is no memory\n", name,
           (n + stride - 1) / stride, refusals - before);
    CHECK(refusals > before);
    free(expected), free(found);
    torus_free(&t);
}

/* No job ends by a signal, however little address space there is for it. */
static void limits_are_answered(void) {
    torus t = torus_new(120, 80);
    double *uv = (double *)room(6 * t.n_faces, sizeof *uv);
    int answered = 0, done = 0;
    ricci_mesh *first = torus_mesh(&t); /* threads and code are there */
    ricci_mesh_free(first);
    for (size_t megabytes = 8; megabytes <= 512; megabytes += megabytes < 64 ? 4 : 64) {
        fflush(stdout);
        const pid_t child = fork();
        CHECK(child >= 0);
        if (child == 0) {
            struct rlimit limit;
            size_t pages = 0;
            FILE *file = fopen("/proc/self/statm", "r");
            CHECK(file && fscanf(file, "%zu", &pages) == 1 && fclose(file) == 0);
            limit.rlim_cur = limit.rlim_max =
                (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + (megabytes << 20);
            CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
            ricci_mesh *mesh = NULL;
            ricci_metric *metric = NULL, *flat = NULL;
            ricci_layout *layout = NULL;
            ricci_status status =
                ricci_mesh_from_arrays(t.positions, 0, t.n_vertices, t.faces, t.n_faces, &mesh);
            if (status == RICCI_OK)
                status = ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric);
            if (status == RICCI_OK) status = ricci_flow(metric, NULL, NULL, NULL, &flat);
            if (status == RICCI_OK) status = ricci_layout_new(flat, NULL, NULL, &layout);
            if (status == RICCI_OK) status = ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 6 * t.n_faces);
            _exit(status == RICCI_OK ? 0 : status == RICCI_NO_MEMORY ? 3 : 1);
        }
        int ended = 0;
        CHECK(waitpid(child, &ended, 0) == child);
        if (!WIFEXITED(ended) || (WEXITSTATUS(ended) != 0 && WEXITSTATUS(ended) != 3))
            printf("%zu MB: status %d, signal %d\n", megabytes, WEXITSTATUS(ended), WTERMSIG(ended));
        CHECK(WIFEXITED(ended) && (WEXITSTATUS(ended) == 0 || WEXITSTATUS(ended) == 3));
        done += WEXITSTATUS(ended) == 0, answered += WEXITSTATUS(ended) == 3;
    }
    printf("%d limits were too low and said so, %d were enough\n", answered, done);
    CHECK(answered > 0 && done > 0);
    free(uv);
    torus_free(&t);
}

int main(int argc, char **argv) {
    const long stride = argc > 1 ? strtol(argv[1], NULL, 10) : 1;
    every_allocation_fails_in_turn(job, "flow and layout", stride);
    every_allocation_fails_in_turn(spline_job, "spline", stride);
    every_allocation_fails_in_turn(patches_job, "patches", stride);
    limits_are_answered();
    return 0;
}
