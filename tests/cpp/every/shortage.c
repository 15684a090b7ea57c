/* Memory runs out in every function of every header: this file and calls.c, which is generated from the
 * headers, stand between a program and the library. The first calls of a function that succeed are made again
 * in children: in some, the system has no memory from the k-th allocation on but what is given back; in
 * others, the address space is limited to a few megabytes more than is in use. The file shortage_NAME.txt has
 * a line for every function that was tried: its name, and the numbers of children that ended with RICCI_OK,
 * with RICCI_NO_MEMORY, and otherwise. The program fails if the last is not 0.
 */
#include "calls.h"
#include <errno.h>
#include <malloc.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

/* Calls of a function that are tried, allocations at which memory runs out in one call, and limits of the
 * address space beyond what is in use, in kilobytes. */
enum { TRIED_CALLS = 2, SHORTAGES = 16 };
static const long LIMITS[] = {0, 256, 1024, 4096, 8192, 16384, 32768, 65536, 131072, 262144};
enum { N_LIMITS = sizeof LIMITS / sizeof *LIMITS };
/* Seconds after which a child is ended. */
enum { MOST_SECONDS = 300 };
/* Rust's own threads take up to 48 bytes from the system beside every allocator: of these the header warns.
 */
enum { THREAD_HANDLE = 48 };

static atomic_int armed;
static atomic_long count, first_refused, left;

/* 1 if the system has no memory for so many more bytes. */
static int refused(size_t size) {
    if (!armed || size <= THREAD_HANDLE) return 0;
    if (atomic_fetch_add(&count, 1) + 1 < first_refused) return 0;
    if (atomic_fetch_sub(&left, (long)size) >= (long)size) return 0;
    atomic_fetch_add(&left, (long)size);
    errno = ENOMEM;
    return 1;
}
static void given_back(size_t size) {
    if (armed && count >= first_refused) atomic_fetch_add(&left, (long)size);
}

void *malloc(size_t size) { return refused(size) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) { return refused(n * size) ? NULL : __libc_calloc(n, size); }
void *realloc(void *p, size_t size) {
    const size_t old = p ? malloc_usable_size(p) : 0;
    if (size > old && refused(size - old)) return NULL;
    return __libc_realloc(p, size);
}
void *memalign(size_t align, size_t size) { return refused(size) ? NULL : __libc_memalign(align, size); }
void *aligned_alloc(size_t align, size_t size) { return memalign(align, size); }
int posix_memalign(void **place, size_t align, size_t size) {
    void *p = memalign(align, size);
    if (p) *place = p;
    return p ? 0 : ENOMEM;
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

/* Filled by children. */
static struct {
    ricci_status status;
    long allocations;
} * told;
static struct { int calls, done, answered, failed; } * tried;

static void write_report(void) {
    char path[256];
    int failed = 0;
    snprintf(path, sizeof path, "%s.txt", program_invocation_short_name);
    FILE *file = fopen(path, "w");
    for (int i = 0; i < CALLS_COUNT; i++) {
        if (tried[i].calls && file)
            fprintf(file, "%s %d %d %d\n", CALLS[i].name, tried[i].done, tried[i].answered, tried[i].failed);
        failed += tried[i].failed;
    }
    if (!file || fclose(file) != 0 || failed) {
        fprintf(stderr, "%d children did not end with a status\n", failed);
        fflush(NULL);
        _exit(1);
    }
}

trials trials_of(int function) {
    if (!tried) {
        told = mmap(NULL, sizeof *told, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        tried = __libc_calloc((size_t)CALLS_COUNT, sizeof *tried);
        if (told == MAP_FAILED || !tried || atexit(write_report) != 0) abort();
    }
    /* Threads of a host have no children. */
    const int is_tried = gettid() == getpid() && tried[function].calls < TRIED_CALLS;
    return (trials){function, is_tried ? -1 : 0, is_tried ? 0 : -1, 0};
}

/* The child of this number: the first one counts, the others are short of memory. */
static void arm(const trials *t) {
    alarm(MOST_SECONDS);
    signal(SIGABRT, SIG_DFL);
    (void)!freopen("/dev/null", "w", stdout);
    if (!getenv("SHORTAGE_LOUD")) (void)!freopen("/dev/null", "w", stderr);
    const int k = t->next - 1;
    if (k < SHORTAGES) {
        const long n = t->allocations;
        /* Each of the first allocations, then allocations that are evenly distributed. */
        const long at = k < 4 || n <= SHORTAGES ? k + 1 : 4 + (n - 4) * (k - 3) / (SHORTAGES - 4);
        first_refused = k < 0 ? 1L << 60 : at;
        count = 0;
        left = 0;
        armed = 1;
        return;
    }
    size_t pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%zu", &pages) != 1 || fclose(file) != 0) _exit(3);
    const rlim_t most = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + ((rlim_t)LIMITS[k - SHORTAGES] << 10);
    const struct rlimit limit = {most, most};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(3);
}

void *trial_control(void) { return NULL; }

_Noreturn void trial_end(ricci_status status) {
    armed = 0;
    told->status = status, told->allocations = count;
    _exit(0);
}

int next_trial(trials *t) {
    while (t->next <= t->last) {
        if (t->next < 0) t->next = 0;
        const int k = t->next - 1;
        fflush(NULL);
        told->status = UINT32_MAX;
        const pid_t child = fork();
        if (child < 0) abort();
        if (child == 0) {
            arm(t);
            return 1;
        }
        int ended = 0;
        if (waitpid(child, &ended, 0) != child) abort();
        const ricci_status status = told->status;
        if (k < 0) {
            /* A call that is refused anyway has no trials. */
            if (ended != 0 || status != RICCI_OK) return 0;
            t->allocations = told->allocations;
            t->last = SHORTAGES + N_LIMITS;
            tried[t->function].calls++;
        } else if (ended == 0 && status == RICCI_OK) {
            tried[t->function].done++;
        } else if (ended == 0 && status == RICCI_NO_MEMORY) {
            tried[t->function].answered++;
        } else {
            tried[t->function].failed++;
            fprintf(stderr, "%s, trial %d, %ld allocations: signal %d, exit code %d, status %u\n",
                    CALLS[t->function].name, k, t->allocations, WIFSIGNALED(ended) ? WTERMSIG(ended) : 0,
                    WIFEXITED(ended) ? WEXITSTATUS(ended) : 0, status);
        }
        t->next++;
    }
    return 0;
}
