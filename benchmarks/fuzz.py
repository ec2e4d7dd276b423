"""Lets hostile input in by every door of the solver, and counts what it does to it.

Run it: python -m benchmarks.fuzz [--count 100000] [--seed 0] [--door NAME ...]
Counts exceptions that are not the project's own, inputs that take more than 2 seconds of processor time, and the
memory of the process. What is wrong is written to out/fuzz/, under the seed that makes it again.
"""

from __future__ import annotations

import argparse
import resource
import signal
import time
import traceback
from collections import Counter
from pathlib import Path
from random import Random
from types import FrameType

from benchmarks.fuzz_inputs import DOORS, attempt, scratch

#: Processor time that one small input may take, and at which it is given up, seconds.
SLOW, HUNG = 2.0, 20
OUT = Path(__file__).resolve().parents[1] / "out" / "fuzz"


class _HungError(BaseException):
    """One input took too long. No Exception: nothing may catch it on the way."""


def _alarm(_signal: int, _frame: FrameType | None) -> None:
    raise _HungError


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100_000, help="inputs in all (default %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of the first input; input k has seed + k")
    parser.add_argument("--door", nargs="+", choices=list(DOORS), default=list(DOORS), help="these doors")
    args = parser.parse_args()
    signal.signal(signal.SIGVTALRM, _alarm)
    wrong: Counter[str] = Counter()
    slowest, began = (0.0, ""), time.perf_counter()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    with scratch() as folder:
        for seed in range(args.seed, args.seed + args.count):
            door = args.door[seed % len(args.door)]
            data = DOORS[door][0](Random(seed))
            start, said = time.process_time(), ""
            signal.setitimer(signal.ITIMER_VIRTUAL, HUNG)
            try:
                attempt(door, data, Path(folder))
            except _HungError:
                said = "hang"
            except Exception as error:
                place = traceback.extract_tb(error.__traceback__)[-1]
                said = f"{type(error).__name__} in {Path(place.filename).name}:{place.lineno}"
            finally:
                signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            spent = time.process_time() - start
            slowest = max(slowest, (spent, f"{door} {seed}"))
            if not said and spent > SLOW:
                said = "slow"
            if said:
                wrong[f"{door}: {said}"] += 1
                OUT.mkdir(parents=True, exist_ok=True)
                (OUT / f"{seed}-{door}.txt").write_bytes(data)
                print(f"seed {seed}  {door}: {said} ({spent:.1f} s)", flush=True)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    seconds = time.perf_counter() - began
    print(f"{args.count:,} inputs in {seconds:.0f} s; slowest {slowest[0]:.1f} s ({slowest[1]})")
    print(f"memory {before:.0f} MB before, {peak:.0f} MB at most")
    for what, count in wrong.most_common():
        print(f"{count:6}  {what}")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
