/* Runs a built kernel on plans from files, without Python: under sanitizers, Wine or an emulator.
 *
 *     harness LIBRARY PLAN...
 *
 * scripts/check_kernel.py writes the plans and compares what is printed: a line for each plan and instruction set,
 * with a checksum of factor and solution. Every array is an allocation of its own and of its exact size, so that an
 * address sanitizer sees the first number read or written beside it. */
#include "plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(KERNEL_LINKED) /* the kernel is part of this program, where no library can be loaded */
#elif defined(_WIN32)
#include <windows.h>
static void *function_of(const char *library, const char *name) {
    HMODULE module = LoadLibraryA(library);
    return module ? (void *)GetProcAddress(module, name) : NULL;
}
#else
#include <dlfcn.h>
static void *function_of(const char *library, const char *name) {
    void *module = dlopen(library, RTLD_NOW);
    return module ? dlsym(module, name) : NULL;
}
#endif

/* The sizes that a plan file begins with. The arrays follow in the order of `read_plan`. */
typedef struct {
    i64 fronts, entries, children, runs, indices, listed, lists;
    i64 unknowns, panels, updates, carried, scratch;
} Sizes;

typedef struct {
    __typeof__(curvefold_level) *level;
    __typeof__(curvefold_factor) *factor;
    __typeof__(curvefold_forward) *forward;
    __typeof__(curvefold_backward) *backward;
} Kernel;

static Kernel load(const char *library) {
#ifdef KERNEL_LINKED
    (void)library;
    return (Kernel){curvefold_level, curvefold_factor, curvefold_forward, curvefold_backward};
#else
#define FUNCTION(name) (__typeof__(curvefold_##name) *)function_of(library, "curvefold_" #name)
    return (Kernel){FUNCTION(level), FUNCTION(factor), FUNCTION(forward), FUNCTION(backward)};
#endif
}

static void fail(const char *why, const char *what) {
    fprintf(stderr, "harness: %s %s\n", why, what);
    exit(2);
}

static void *allocate(size_t bytes) {
    void *p = malloc(bytes ? bytes : 1);
    if (!p) fail("no memory", "");
    return p;
}

static void *take(FILE *file, i64 count, size_t size) {
    void *p = allocate((size_t)count * size);
    if (fread(p, size, (size_t)count, file) != (size_t)count) fail("a plan file is too short", "");
    return p;
}

/* Storage as malloc may give it: full of what would spoil every sum. */
static double *spoilt(i64 count) {
    double *p = allocate((size_t)count * sizeof(double));
    memset(p, 0xff, (size_t)count * sizeof(double)); /* nan */
    return p;
}

static uint64_t checksum(uint64_t sum, const double *values, i64 count) { /* FNV-1a, a double at a time */
    for (i64 i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, values + i, sizeof bits);
        sum = (sum ^ bits) * 1099511628211u;
    }
    return sum;
}

static void run_plan(const Kernel *kernel, const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) fail("cannot open", path);
    Sizes *n = take(file, 1, sizeof(Sizes));
    Front *fronts = take(file, n->fronts, sizeof(Front));
    i32 *source = take(file, n->entries, sizeof(i32)), *target = take(file, n->entries, sizeof(i32));
    i32 *children = take(file, n->children, sizeof(i32));
    Run *runs = take(file, n->runs, sizeof(Run));
    i32 *indices = take(file, n->indices, sizeof(i32));
    i32 *listed = take(file, n->listed, sizeof(i32));
    i64 *lengths = take(file, n->lists, sizeof(i64));
    double *values = take(file, n->entries, sizeof(double)), *rhs = take(file, n->unknowns, sizeof(double));
    fclose(file);

    for (i64 level = 1; level <= kernel->level(); level++) {
        double *panels = spoilt(n->panels), *updates = spoilt(n->updates), *carried = spoilt(n->carried);
        double *scratch = spoilt(2 * n->scratch), *x = spoilt(n->unknowns), *again = spoilt(n->unknowns);
        Plan plan = {fronts, source, target, children, runs, indices, panels, updates, carried, scratch, n->scratch};
        memcpy(x, rhs, (size_t)n->unknowns * sizeof(double));
        memcpy(again, rhs, (size_t)n->unknowns * sizeof(double));

        i64 refused = 0, at = 0;
        for (i64 k = 0; k < n->lists && !refused; at += lengths[k++])
            refused = kernel->factor(&plan, level, k % 2, listed + at, lengths[k], values, x);
        if (refused) {
            printf("level %d refused front %d\n", (int)level, (int)refused - 1);
        } else {
            i64 start = 0;
            for (i64 k = 0; k < n->lists; start += lengths[k++])
                kernel->forward(&plan, level, k % 2, listed + start, lengths[k], again);
            for (i64 k = n->lists - 1; k >= 0; k--) {
                start -= lengths[k];
                kernel->backward(&plan, level, k % 2, listed + start, lengths[k], x);
                kernel->backward(&plan, level, k % 2, listed + start, lengths[k], again);
            }
            const int same = memcmp(x, again, (size_t)n->unknowns * sizeof(double)) == 0;
            const uint64_t sum = checksum(checksum(14695981039346656037u, panels, n->panels), x, n->unknowns);
            printf("level %d %016llx%s\n", (int)level, (unsigned long long)sum, same ? "" : " fused differs");
        }
        free(panels), free(updates), free(carried), free(scratch), free(x), free(again);
    }
    free(n), free(fronts), free(source), free(target), free(children), free(runs), free(indices), free(listed);
    free(lengths), free(values), free(rhs);
}

int main(int count, char **arguments) {
    if (count < 3) fail("harness LIBRARY PLAN...", "");
    const Kernel kernel = load(arguments[1]);
    if (!kernel.level || !kernel.factor || !kernel.forward || !kernel.backward) fail("cannot load", arguments[1]);
    if (kernel.level() < 1) fail("no instruction set of the kernel is here", "");
    for (int i = 2; i < count; i++) {
        printf("plan %d\n", i - 1);
        run_plan(&kernel, arguments[i]);
    }
    return 0;
}
