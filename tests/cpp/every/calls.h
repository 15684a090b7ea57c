/* Calls of the library that are made again in children of the process: shortage.c takes their memory away,
 * progress.c watches and cancels them.
 */
#ifndef CALLS_H
#define CALLS_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <dlfcn.h>
#include <ricci/ricci.h>

/* The trials of one call. */
typedef struct trials {
    int function, next, last;
    long allocations;
} trials;

/* The functions that return a status, in the order of their numbers; long ones take a control. */
typedef struct call_function {
    const char *name;
    int is_long;
} call_function;
extern const call_function CALLS[];
extern const int CALLS_COUNT;

trials trials_of(int function);
/* 1 in a child in which the call is to be made, 0 in the process itself when all children have ended. */
int next_trial(trials *trials);
/* The end of a child. */
_Noreturn void trial_end(ricci_status status);

/* The control of a child's call; NULL where progress is not watched. */
void *trial_control(void);

/* The body of a function that stands before the library's of the same name. */
#define FORWARD(number, name, arguments, before)                                                             \
    static __typeof__(&name) real;                                                                           \
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                                                    \
    trials all = trials_of(number);                                                                          \
    while (next_trial(&all)) {                                                                               \
        before;                                                                                              \
        trial_end(real arguments);                                                                           \
    }                                                                                                        \
    return real arguments

#endif
