"""What all fuzzers share: doors, one input let in by one of them, and a count of what inputs do."""

from __future__ import annotations

import argparse
import resource
import signal
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random
from types import FrameType

#: Processor time that one small input may take, and at which it is given up, seconds.
SLOW, HUNG = 2.0, 20
OUT = Path(__file__).resolve().parents[1] / "out" / "fuzz"


@dataclass(frozen=True)
class Door:
    """One way in.

    make      input, the same for the same random numbers
    use       lets it in; there is a folder for files
    refusals  errors that are the project's own, in one line
    leaves    names, without suffix, that may stand in the folder afterwards
    """

    make: Callable[[Random], bytes]
    use: Callable[[bytes, Path], None]
    refusals: tuple[type[Exception], ...]
    leaves: frozenset[str]


class HungError(BaseException):
    """One input took too long. No Exception: nothing may catch it on the way."""


def alarm(_signal: int, _frame: FrameType | None) -> None:
    raise HungError


def scratch() -> tempfile.TemporaryDirectory[str]:
    """A folder of its own."""
    return tempfile.TemporaryDirectory(prefix="curvefold-fuzz-")


def attempt(door: Door, data: bytes, folder: Path) -> None:
    """Let data in by a door. What the project refuses is fine; everything else that is raised comes through."""
    try:
        door.use(data, folder)
    except door.refusals as error:
        if len(str(error).splitlines()) != 1:
            raise AssertionError(f"not one line: {error}") from error
    strange = [path.name for path in folder.iterdir() if path.stem not in door.leaves]
    if strange:
        raise AssertionError(f"wrote {strange}")


def tried(door: Door, data: bytes, folder: Path, slow: float, hung: float) -> tuple[str, float]:
    """What is wrong with data, "" for nothing, and the processor time it took, seconds; given up after ``hung``.

    ``alarm`` has to be the handler of SIGVTALRM.
    """
    start, said = time.process_time(), ""
    signal.setitimer(signal.ITIMER_VIRTUAL, hung)
    try:
        attempt(door, data, folder)
    except HungError:
        said = "hang"
    except Exception as error:  # of whatever kind: it is what is looked for
        said = said_of(error)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    spent = time.process_time() - start
    return said or ("slow" if spent > slow else ""), spent


def said_of(error: Exception) -> str:
    """What an error is and where it comes from."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} in {Path(place.filename).name}:{place.lineno}"


def run(doors: Mapping[str, Door], module: str, words: str) -> int:
    """The command line of a fuzzer: lets inputs in, prints what was wrong; 1 when anything was."""
    parser = argparse.ArgumentParser(prog=f"python -m {module}", description=words)
    parser.add_argument("--count", type=int, default=100_000, help="inputs in all (default %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of the first input; input k has seed + k")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="end then, with what was done")
    parser.add_argument("--door", nargs="+", choices=list(doors), default=list(doors), help="these doors")
    args = parser.parse_args()
    signal.signal(signal.SIGVTALRM, alarm)
    OUT.mkdir(parents=True, exist_ok=True)
    wrong: Counter[str] = Counter()
    slowest, began = (0.0, ""), time.perf_counter()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    with scratch() as scratched:
        folders = {name: Path(scratched) / name for name in args.door}
        for folder in folders.values():
            folder.mkdir()
        done = 0
        for seed in range(args.seed, args.seed + args.count):
            if time.perf_counter() - began > args.seconds:
                break
            done += 1
            name = args.door[seed % len(args.door)]
            data = doors[name].make(Random(seed))
            # Written before it is tried: an input that ends the process is still there.
            kept = OUT / f"{seed}-{name}.txt"
            kept.write_bytes(data)
            said, spent = tried(doors[name], data, folders[name], SLOW, HUNG)
            slowest = max(slowest, (spent, f"{name} {seed}"))
            if said:
                wrong[f"{name}: {said}"] += 1
                print(f"seed {seed}  {name}: {said} ({spent:.1f} s)", flush=True)
            else:
                kept.unlink()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    seconds = time.perf_counter() - began
    print(f"{done:,} inputs in {seconds:.0f} s; slowest {slowest[0]:.1f} s ({slowest[1]})")
    print(f"memory {before:.0f} MB before, {peak:.0f} MB at most")
    for what, count in wrong.most_common():
        print(f"{count:6}  {what}")
    return 1 if wrong else 0
