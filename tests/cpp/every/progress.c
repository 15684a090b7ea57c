/* Progress and cancelling of every long call of every header: this file and calls.c, which is generated from
 * the headers, stand between a program and the library. The first calls of a function that succeed are made
 * again in children, under the eyes of a thread that reads the control as fast as it can. In the first child
 * progress never goes back and ends at 1; in the second the control was cancelled before; in the others it is
 * cancelled where a share of the progress seen in the first one is reached. The file progress_NAME.txt has a
 * line for every function: its name, the number of different fractions that were seen, the longest time
 * between cancelling and the end in milliseconds, and the number of children that ended otherwise. The
 * program fails if that is not 0. Times are reported and not judged.
 */
#include "calls.h"
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { TRIED_CALLS = 2, SHARES = 3, MOST_SECONDS = 300 };

/* Filled by children. */
static struct {
    ricci_status status;
    int fractions, went_back, ended;
    double last, latency;
} * told;
static struct {
    int calls, fractions, failed;
    double latency;
} * tried;
/* In a child: its control, the fraction at which it cancels, and the end of the call. */
static ricci_control *watched;
static double cancels_at;
static atomic_int is_over;
static pthread_t watcher;

static void write_report(void) {
    char path[256];
    int failed = 0;
    snprintf(path, sizeof path, "%s.txt", program_invocation_short_name);
    FILE *file = fopen(path, "w");
    for (int i = 0; i < CALLS_COUNT; i++) {
        if (tried[i].calls && file)
            fprintf(file, "%s %d %.1f %d\n", CALLS[i].name, tried[i].fractions, 1e3 * tried[i].latency,
                    tried[i].failed);
        failed += tried[i].failed;
    }
    if (!file || fclose(file) != 0 || failed) {
        fprintf(stderr, "%d children ended otherwise\n", failed);
        fflush(NULL);
        _exit(1);
    }
}

trials trials_of(int function) {
    if (!tried) {
        told = mmap(NULL, sizeof *told, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        tried = calloc((size_t)CALLS_COUNT, sizeof *tried);
        if (told == MAP_FAILED || !tried || atexit(write_report) != 0) abort();
    }
    const int is_tried =
        CALLS[function].is_long && gettid() == getpid() && tried[function].calls < TRIED_CALLS;
    return (trials){function, 0, is_tried ? 1 : 0, 0};
}

static void *watch(void *unused) {
    uint32_t stage;
    double fraction, before = -1;
    (void)unused;
    for (;;) {
        const int was_over = is_over;
        if (ricci_control_progress(watched, &stage, &fraction, NULL) != RICCI_OK) abort();
        told->fractions += fraction != before;
        told->went_back += !(fraction >= before && fraction <= 1);
        told->last = before = fraction;
        if (fraction >= cancels_at && ricci_control_cancel(watched) != RICCI_OK) abort();
        if (was_over) return NULL;
    }
}

void *trial_control(void) { return watched; }

static void begin(const trials *t) {
    alarm(MOST_SECONDS);
    if (ricci_control_new(&watched) != RICCI_OK) abort();
    const int k = t->next;
    if (k == 1 && ricci_control_cancel(watched) != RICCI_OK) abort();
    cancels_at = k < 2 ? 2 : (k - 1) / (SHARES + 1.0);
    if (pthread_create(&watcher, NULL, watch, NULL) != 0) abort();
}

_Noreturn void trial_end(ricci_status status) {
    uint32_t stage;
    double fraction, since = -1;
    if (ricci_control_progress(watched, &stage, &fraction, &since) != RICCI_OK) abort();
    is_over = 1;
    pthread_join(watcher, NULL);
    told->status = status, told->latency = since;
    _exit(0);
}

/* 1 if a child ended as it must. */
static int is_right(int k, int ended) {
    if (ended != 0 || told->went_back) return 0;
    if (k == 0) return told->last == 1;
    if (k == 1) return told->status == RICCI_CANCELLED;
    return told->status == RICCI_CANCELLED || (told->status == RICCI_OK && told->last == 1);
}

int next_trial(trials *t) {
    while (t->next < t->last) {
        fflush(NULL);
        memset(told, 0, sizeof *told);
        told->status = UINT32_MAX;
        const pid_t child = fork();
        if (child < 0) abort();
        if (child == 0) {
            begin(t);
            return 1;
        }
        int ended = 0;
        if (waitpid(child, &ended, 0) != child) abort();
        const int k = t->next++;
        if (k == 0) {
            /* A call that is refused anyway has no trials. */
            if (ended == 0 && told->status != RICCI_OK) return 0;
            tried[t->function].calls++;
            t->last = 2 + SHARES;
            if (told->fractions > tried[t->function].fractions)
                tried[t->function].fractions = told->fractions;
        } else if (k > 1 && told->status == RICCI_CANCELLED && told->latency > tried[t->function].latency) {
            tried[t->function].latency = told->latency;
        }
        if (!is_right(k, ended)) {
            tried[t->function].failed++;
            fprintf(stderr, "%s, trial %d: signal %d, status %u, progress %g, back %d times\n",
                    CALLS[t->function].name, k, WIFSIGNALED(ended) ? WTERMSIG(ended) : 0, told->status,
                    told->last, told->went_back);
        }
    }
    return 0;
}
