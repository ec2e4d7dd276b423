"""Lets hostile input in by every door of the solver, and counts what it does to it.

Run it: python -m benchmarks.fuzz [--count 100000] [--seed 0] [--door NAME ...]
Counts exceptions that are not the project's own, inputs that take more than 2 seconds of processor time, and the
memory of the process. What is wrong is written to out/fuzz/, under the seed that makes it again.
"""

from __future__ import annotations

from benchmarks.fuzz_inputs import DOORS
from benchmarks.fuzz_run import run

if __name__ == "__main__":
    raise SystemExit(run(DOORS, "benchmarks.fuzz", __doc__.splitlines()[0]))
