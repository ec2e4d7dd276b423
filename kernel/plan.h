/* What Python and the kernel share: one factorisation's plan, as solver/optimize/multifrontal/plan.py lays it out.
 *
 * Nothing here is checked in C. Python refuses a plan whose numbers do not fit before it passes any pointer.
 * Whoever changes a struct or a function's arguments raises CURVEFOLD_ABI, here and in solver/optimize/kernel.py. */
#ifndef CURVEFOLD_PLAN_H
#define CURVEFOLD_PLAN_H
#include <stdint.h>

#define CURVEFOLD_ABI 1

#ifdef _WIN32
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif

typedef int64_t i64;
typedef int32_t i32;

/* Sizes and places in a front's storage are multiples of this many doubles, so that no loop has a remainder. */
enum { UNIT = 8 };

/* One front: the dense block
 *
 *       wide
 *     [ L11      ]  wide      pivots, then columns of the identity
 *     [ L21   U  ]  tall      border, then rows of zeros
 *
 * The panel holds L11 over L21, column-major, `height` apart. The diagonal of L11 holds the pivots' inverses.
 * The update U (tall x tall, lower triangle) is what its elimination adds to the fronts that come later. */
typedef struct {
    i64 pivots, wide;             /* unknowns eliminated here, and rounded up to UNIT */
    i64 border, tall;             /* later unknowns that they are coupled to, and rounded up to UNIT */
    i64 height;                   /* wide + tall */
    i64 panel, update, carried;   /* where its panel, update and part of a right-hand side begin */
    i64 first;                    /* its first pivot, in the order of elimination */
    i64 entries, entries_end;     /* its entries of the matrix: Plan.source, Plan.target */
    i64 children, children_end;   /* the fronts whose updates it takes: Plan.children */
    i64 runs, runs_end;           /* where its border lies in its parent: Plan.runs */
    i64 indices;                  /* its border's unknowns: Plan.indices */
} Front;

/* Border rows from .. from+count-1 of a child are the rows to .. to+count-1 of its parent. */
typedef struct {
    i32 from, to, count;
} Run;

typedef struct {
    const Front *fronts;
    const i32 *source, *target;   /* value `source` of the matrix goes to place `target` of its front's panel */
    const i32 *children;
    const Run *runs;
    const i32 *indices;
    double *panels, *updates, *carried;
    double *scratch;              /* of `scratch_size` for each of two threads */
    i64 scratch_size;
} Plan;

/* kernel.c says what each of them does. */
API void curvefold_layout(i64 layout[4]);
API i64 curvefold_level(void);
API i64 curvefold_factor(const Plan *, i64 level, i64 thread, const i32 *list, i64 count, const double *values, double *x);
API void curvefold_forward(const Plan *, i64 level, i64 thread, const i32 *list, i64 count, double *x);
API void curvefold_backward(const Plan *, i64 level, i64 thread, const i32 *list, i64 count, double *x);

#endif
