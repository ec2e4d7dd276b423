"""Lets input in by the solver's doors that is bred for reaching new lines of the code, by atheris (libFuzzer).

Run it: python -m benchmarks.fuzz_coverage [--seconds 600] [--door NAME ...]
In an environment of its own (Python 3.11): pip install -r requirements/bundled.txt numpy==1.26.4 atheris==3.0.0
Watched are the lines of the solver and of svgelements. What is wrong is written to out/fuzz/, and tried again
without atheris, which makes Python three to five times slower; what has been bred is kept in out/fuzz/bred/DOOR
for the next run.
"""

from __future__ import annotations

import argparse
import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from random import Random

from benchmarks import fuzz_run
from benchmarks.fuzz_run import OUT

ROOT = Path(__file__).resolve().parents[1]
#: Names of doors, as in benchmarks.fuzz_inputs: not imported here, atheris has to see it first.
DOORS = ("svg", "fold", "handles", "description")
#: Inputs that the breeding begins with, for each door.
SEEDS = 80
#: The longest input, bytes: the samples are shorter, and what is longer is slow and tells nothing more.
LONGEST = 8192
#: Processor time that an input may take, and at which it is given up, seconds; the first without atheris.
SLOW, HUNG = 2.0, 30
#: Memory at which libFuzzer stops, MB.
MEMORY = 1500


def breed(door: str, seconds: int, seed: int) -> None:
    """Runs libFuzzer, which ends the process, for one door."""
    import atheris  # no part of the product or of its tests

    with atheris.instrument_imports(include=["solver", "svgelements"]):
        import solver  # noqa: F401
        from benchmarks import fuzz_inputs
    folder = OUT / "bred" / door
    folder.mkdir(parents=True, exist_ok=True)
    for k in range(SEEDS):
        (folder / f"seed-{k}").write_bytes(fuzz_inputs.DOORS[door].make(Random(k))[:LONGEST])
    if door == "svg":
        for path in fuzz_inputs.FOLDER.glob("*.svg"):
            (folder / path.stem).write_bytes(path.read_bytes())
    if door == "description":
        for k in range(SEEDS):
            (folder / f"true-{k}").write_text(json.dumps(fuzz_inputs.true_description(Random(k))))
    known: set[str] = set()
    signal.signal(signal.SIGVTALRM, fuzz_run.alarm)

    def attempt(data: bytes) -> None:
        """One input. What is wrong is kept, once for each place, and the breeding goes on."""
        said, _ = fuzz_run.tried(fuzz_inputs.DOORS[door], data, scratch, 3 * SLOW, HUNG)
        if said and said not in known:
            known.add(said)
            (OUT / f"bred-{door}-{len(known)}.txt").write_bytes(data)
            print(f"{door}: {said}", flush=True)

    def mutate(data: bytes, longest: int, number: int) -> bytes:
        """libFuzzer's own small changes, and changes that know what the bytes mean."""
        rng = Random(number)
        if rng.random() < 0.4:
            return atheris.Mutate(data, longest)
        if door == "svg":
            return fuzz_inputs.changed_svg(rng, data)[:longest]
        try:
            value = json.loads(data)
        except (ValueError, RecursionError):
            return fuzz_inputs.spoilt(rng, data)[:longest]
        return json.dumps(fuzz_inputs.changed_json(rng, value)).encode()[:longest]

    with fuzz_run.scratch() as name:
        scratch = Path(name)
        arguments = [f"-max_total_time={seconds}", f"-max_len={LONGEST}", f"-rss_limit_mb={MEMORY}", "-timeout=120"]
        arguments += [f"-seed={seed}", "-print_final_stats=1", str(folder)]
        atheris.Setup([sys.argv[0], *arguments], attempt, custom_mutator=mutate)
        atheris.Fuzz()


def again(door: str, path: Path) -> str:
    """What is wrong with an input without atheris: "" for nothing."""
    from benchmarks import fuzz_inputs

    start = time.process_time()
    with fuzz_run.scratch() as folder:
        try:
            fuzz_run.attempt(fuzz_inputs.DOORS[door], path.read_bytes(), Path(folder))
        except Exception as error:
            return f"{fuzz_run.said_of(error)}: {error}"
    spent = time.process_time() - start
    return f"slow: {spent:.1f} s" if spent > SLOW else ""


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzz_coverage", description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=int, default=600, help="in all (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of libFuzzer (default %(default)s)")
    parser.add_argument("--door", nargs="+", choices=DOORS, default=list(DOORS), help="these doors")
    parser.add_argument("--breed", choices=DOORS, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.breed:
        breed(args.breed, args.seconds, args.seed)
    OUT.mkdir(parents=True, exist_ok=True)
    wrong = 0
    for door in args.door:
        for old in OUT.glob(f"bred-{door}-*.txt"):
            old.unlink()
        share = args.seconds // len(args.door)
        command = [sys.executable, "-m", "benchmarks.fuzz_coverage", "--breed", door]
        command += ["--seconds", str(share), "--seed", str(args.seed)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        (OUT / f"bred-{door}.log").write_text(done.stdout + done.stderr)
        lines = re.findall(r"^#(\d+)\s+\w+\s+cov: (\d+) ft: (\d+)", done.stderr, re.MULTILINE)
        stats = dict(re.findall(r"^stat::(\w+):\s+(\d+)", done.stderr, re.MULTILINE))
        if done.returncode or not lines or not stats:
            wrong += 1
            print(f"{door}: libFuzzer ended with {done.returncode}: {OUT}/bred-{door}.log")
            continue
        print(
            f"{door}: {int(stats['number_of_executed_units']):,} inputs in {share} s, branches reached "
            f"{lines[0][1]} at first, {lines[-1][1]} in the end, memory {stats['peak_rss_mb']} MB at most"
        )
        for path in sorted(OUT.glob(f"bred-{door}-*.txt")):
            said = again(door, path)
            wrong += bool(said)
            print(f"  {path.name}: {said or 'nothing wrong without atheris'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
