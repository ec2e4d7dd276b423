/* Multifrontal Cholesky on fronts that Python has planned. No libraries, no allocation, no threads, no globals that
 * change: two threads may work on different fronts of one plan at once. Built by scripts/kernel.py. */
#include "plan.h"

/* a b + c, rounded once. It is said outright, since whether a compiler fuses by itself is up to it, and changes the
 * bits. Only the checking build with gcc leaves it to the compiler. */
#ifdef __clang__
#define UNROLL _Pragma("clang loop unroll(full)")
#define FUSE(a, b, c) __builtin_elementwise_fma(a, b, c)
#define FUSE_ONE(a, b, c) __builtin_fma(a, b, c)
#else
#define UNROLL _Pragma("GCC unroll 8")
#define FUSE(a, b, c) ((a) * (b) + (c))
#define FUSE_ONE(a, b, c) ((a) * (b) + (c))
#endif
#define NOINLINE __attribute__((noinline)) /* so that profiles show the parts */
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

/* One instruction set. */
typedef struct {
    int (*factor)(const Plan *, const Front *, const double *);
    void (*forward)(const Plan *, const Front *, double *, double *);
    void (*backward)(const Plan *, const Front *, double *, double *);
} Set;

#if defined(__x86_64__)

#include <cpuid.h>

#define NAME(x) JOIN(x, _avx2)
#define TARGET __attribute__((target("avx2,fma")))
#define VL 4
#define MV 2
#define NR 4
#include "front.inc"

#define NAME(x) JOIN(x, _avx512)
#define TARGET __attribute__((target("avx512f,avx512dq,avx512vl,avx2,fma")))
#define VL 8
#define MV 3
#define NR 8
#include "front.inc"

static const Set sets[] = {{factor_avx2, forward_avx2, backward_avx2},
                           {factor_avx512, forward_avx512, backward_avx512}};

/* What processor and operating system both allow. */
static i64 best_level(void) {
    enum { SSE_AND_AVX_KEPT = 0x6, AVX512_KEPT = 0xe6 }; /* bits of XCR0: registers saved at a task switch */
    const unsigned wide = bit_AVX512F | bit_AVX512DQ | bit_AVX512VL;
    unsigned a, b, c, d, kept, high;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE) || !(c & bit_FMA)) return 0;
    __asm__ volatile("xgetbv" : "=a"(kept), "=d"(high) : "c"(0));
    if ((kept & SSE_AND_AVX_KEPT) != SSE_AND_AVX_KEPT) return 0;
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d) || !(b & bit_AVX2)) return 0;
    return (kept & AVX512_KEPT) == AVX512_KEPT && (b & wide) == wide ? 2 : 1;
}

#elif defined(__aarch64__)

#define NAME(x) JOIN(x, _neon)
#define TARGET
#define VL 2
#define MV 6
#define NR 4
#include "front.inc"

static const Set sets[] = {{factor_neon, forward_neon, backward_neon}};

static i64 best_level(void) { return 1; }

#else
#error "no instruction set is known for this machine"
#endif

/* ABI number and the sizes of the structs, which Python compares with its own. */
void curvefold_layout(i64 layout[4]) {
    layout[0] = CURVEFOLD_ABI;
    layout[1] = sizeof(Front);
    layout[2] = sizeof(Run);
    layout[3] = sizeof(Plan);
}

/* The best instruction set that this machine has: 1 is AVX2 or NEON, 2 is AVX-512, 0 is none. Every function below
 * takes a `level` from 1 to this one. */
i64 curvefold_level(void) { return best_level(); }

/* Factors fronts list[0 .. count-1] in turn. With x (in the order of elimination, or null) it also solves L y = x on
 * the way, while the panels are in the cache. thread: 0 or 1, for its scratch. Returns 1 + the front that is not
 * positive definite, else 0. */
i64 curvefold_factor(const Plan *plan, i64 level, i64 thread, const i32 *list, i64 count, const double *values,
                         double *x) {
    const Set *set = &sets[level - 1];
    double *scratch = plan->scratch + thread * plan->scratch_size;
    for (i64 k = 0; k < count; k++) {
        const Front *front = plan->fronts + list[k];
        if (!set->factor(plan, front, values)) return 1 + list[k];
        if (x) set->forward(plan, front, x, scratch);
    }
    return 0;
}

/* L y = x on the fronts of the list, in place. */
void curvefold_forward(const Plan *plan, i64 level, i64 thread, const i32 *list, i64 count, double *x) {
    double *scratch = plan->scratch + thread * plan->scratch_size;
    for (i64 k = 0; k < count; k++) sets[level - 1].forward(plan, plan->fronts + list[k], x, scratch);
}

/* Lᵀ z = y on the fronts of the list, last one first, in place. */
void curvefold_backward(const Plan *plan, i64 level, i64 thread, const i32 *list, i64 count, double *x) {
    double *scratch = plan->scratch + thread * plan->scratch_size;
    for (i64 k = count - 1; k >= 0; k--) sets[level - 1].backward(plan, plan->fronts + list[k], x, scratch);
}

#ifdef _WIN32
/* The loader wants an entry point; without a C library there is none. */
int __stdcall DllMainCRTStartup(void *module, unsigned long reason, void *reserved) {
    (void)module, (void)reason, (void)reserved;
    return 1;
}
#endif
