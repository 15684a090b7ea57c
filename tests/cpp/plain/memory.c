/* Memory that the system refuses is RICCI_NO_MEMORY, and nothing is changed: every allocation of one job is
 * made to fail in turn, and all that follow until a large block is given back; then jobs run under limits of
 * the address space. Usage: test_memory [STRIDE]: every STRIDE-th allocation only.
 */
#define _GNU_SOURCE
#include "torus.h"
#include <errno.h>
#include <malloc.h>
#include <ricci/bicubic.h>
#include <ricci/circles.h>
#include <ricci/flatten.h>
#include <ricci/harmonic.h>
#include <ricci/match.h>
#include <ricci/repair.h>
#include <ricci/shapes.h>
#include <ricci/structure.h>
#include <ricci/uniformize.h>
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
/* Number of allocations of a longer job that begin a shortage, evenly distributed. */
enum { MOST_RUNS = 3000 };

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
    ricci_solver *solver = NULL;
    ricci_layout *layout = NULL;
    ricci_map *map = NULL;
    ricci_flow_options options;
    ricci_layout_options laid;
    INIT(options), INIT(laid);
    options.threads = 1, laid.threads = 1;
    MUST(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, t->n_faces, &mesh));
    MUST(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    MUST(ricci_solver_new(metric, &options, &solver));
    MUST(ricci_solver_pin(solver, NULL, 0));
    MUST(ricci_solver_solve(solver, NULL, NULL, &flat));
    ricci_solver_free(solver), ricci_metric_free(flat);
    flat = NULL;
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

/* Canonical shape, group, forms, charts and a map of a torus; `values` gets numbers of each. */
static void canonical_job(const torus *t, double *values) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *uniform = NULL;
    ricci_deck *deck = NULL;
    ricci_dirichlet *dirichlet = NULL;
    ricci_forms *forms = NULL;
    ricci_structure *structure = NULL;
    ricci_matching *matching = NULL;
    ricci_flow_options flow;
    ricci_uniform_options uniform_options;
    ricci_structure_options structure_options;
    ricci_match_options match_options;
    ricci_deck_spec spec;
    ricci_matching_summary summary;
    INIT(flow), INIT(uniform_options), INIT(structure_options), INIT(match_options), INIT(spec);
    flow.threads = 1, match_options.threads = 1;
    uniform_options.flow = &flow, structure_options.flow = &flow;
    spec.kind = RICCI_DECK_DEPTH, spec.depth = 2, spec.limit = 20;
    MUST(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, t->n_faces, &mesh));
    MUST(ricci_uniformize(mesh, &uniform_options, NULL, &uniform));
    MUST(ricci_deck_new(uniform, &spec, NULL, &deck));
    MUST(ricci_deck_values(deck, RICCI_DECK_LENGTH, values, 20));
    MUST(ricci_dirichlet_new(uniform, NULL, NULL, &dirichlet));
    MUST(ricci_forms_new(mesh, NULL, NULL, &forms));
    MUST(ricci_forms_periods(forms, values + 20, 2));
    MUST(ricci_structure_new(mesh, RICCI_STRUCTURE_AFFINE, &structure_options, NULL, &structure));
    MUST(ricci_structure_holonomy(structure, values + 22, 24));
    MUST(ricci_match(mesh, mesh, &match_options, NULL, &matching));
    MUST(ricci_matching_summarise(matching, &summary, sizeof summary));
    values[46] = summary.energy;
    ricci_matching_free(matching), ricci_structure_free(structure), ricci_forms_free(forms);
    ricci_dirichlet_free(dirichlet), ricci_deck_free(deck), ricci_uniform_free(uniform);
    ricci_mesh_free(mesh);
}

/* A list that is repaired, written and read again, sample surfaces, and circles. */
static void files_job(const torus *t, double *values) {
    ricci_soup *soup = NULL, *repaired = NULL;
    ricci_mesh *read = NULL, *ring = NULL, *noisy = NULL;
    ricci_circle_domain *domain = NULL;
    ricci_circle_domain_options options;
    ricci_flow_options flow;
    ricci_shape shape;
    ricci_change_spec change;
    INIT(options), INIT(flow), INIT(shape), INIT(change);
    flow.threads = 1, options.flow = &flow;
    shape.shape = RICCI_SHAPE_ANNULUS, shape.n = 2, shape.m = 8, shape.a = 0.5, shape.b = 1;
    change.change = RICCI_CHANGE_NOISE, change.amount = 0.01;
    MUST(ricci_soup_from_arrays(t->positions, 0, t->n_vertices, t->faces, t->n_faces, &soup));
    MUST(ricci_soup_repair(soup, NULL, &repaired));
    MUST(ricci_soup_write(repaired, "shortage.obj"));
    MUST(ricci_mesh_read("shortage.obj", &read));
    MUST(ricci_mesh_values(read, RICCI_POSITIONS, values, 3 * t->n_vertices));
    MUST(ricci_make(&shape, &ring));
    MUST(ricci_change(ring, &change, &noisy));
    MUST(ricci_circle_domain_new(noisy, &options, NULL, &domain));
    MUST(ricci_circle_domain_circles(domain, values + 3 * t->n_vertices, 8));
    ricci_circle_domain_free(domain), ricci_mesh_free(noisy), ricci_mesh_free(ring);
    ricci_mesh_free(read), ricci_soup_free(repaired), ricci_soup_free(soup);
}

/* Sizes that no memory holds are refused before anything is made of them. */
static void sizes_are_answered(void) {
    static const uint32_t shapes[] = {RICCI_SHAPE_SPHERE, RICCI_SHAPE_TORUS, RICCI_SHAPE_GENUS,
                                      RICCI_SHAPE_BOLZA,  RICCI_SHAPE_PANTS, RICCI_SHAPE_FLAT_TORUS};
    int answered = 0;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        const int levels = shapes[i] == RICCI_SHAPE_BOLZA || shapes[i] == RICCI_SHAPE_PANTS;
        ricci_mesh *mesh = NULL;
        ricci_shape shape;
        INIT(shape);
        shape.shape = shapes[i], shape.genus = 2, shape.n = shape.m = levels ? 14 : 12000;
        shape.a = 2, shape.b = 1, shape.c = 1;
        const ricci_status status = ricci_make(&shape, &mesh);
        CHECK(status == RICCI_NO_MEMORY || status == RICCI_TOO_LARGE || status == RICCI_ARGUMENT);
        CHECK(mesh == NULL);
        answered += status == RICCI_NO_MEMORY;
    }
    printf("%d surfaces are too large for the memory, and it is said\n", answered);
    CHECK(answered > 0);
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
    if (n / stride > MOST_RUNS) stride = n / MOST_RUNS;
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

/* No job ends by a signal, however little address space there is for it and its threads. */
static void limits_are_answered(void) {
    torus t = torus_new(120, 80);
    double *uv = (double *)room(6 * t.n_faces, sizeof *uv);
    int answered = 0, done = 0;
    ricci_mesh *first = torus_mesh(&t); /* threads and code are there */
    ricci_mesh_free(first);
    for (size_t megabytes = 8; megabytes <= 512; megabytes += megabytes < 64 ? 1 : 8) {
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
    every_allocation_fails_in_turn(canonical_job, "canonical shapes, forms, charts and maps", stride);
    every_allocation_fails_in_turn(files_job, "files, samples and circles", stride);
    fflush(stdout);
    const pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        const struct rlimit limit = {(rlim_t)4 << 30, (rlim_t)4 << 30};
        CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
        sizes_are_answered();
        exit(0);
    }
    int ended = 0;
    CHECK(waitpid(child, &ended, 0) == child && WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    limits_are_answered();
    return 0;
}
