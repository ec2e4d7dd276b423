"""Runs the compiled kernel where Python does not: under sanitizers, as the Windows library, and on ARM.

    python scripts/check_kernel.py                  (make test-kernel; a few minutes)

A small program (kernel/harness.c) runs plans from files: of square grids, of a random graph, and of plans with one
wrong number that the solver's own check lets pass. The address and undefined-behaviour sanitizers (cc) must find
nothing. All builds by zig must print the same checksums: this machine's, Windows by Wine and ARM by qemu (Debian's
packages wine64 and qemu-user-static). What cannot be run is named. macOS runs on Apple's machines only.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import kernel_wheels  # noqa: E402

from benchmarks.linear_system import diamond_pattern, dominant_values  # noqa: E402
from solver.optimize.multifrontal.ordering import dissect, vertex_graph  # noqa: E402
from solver.optimize.multifrontal.plan import BrokenPlanError, KernelPlan, check, lay_out  # noqa: E402
from solver.optimize.multifrontal.symbolic import analyse  # noqa: E402

HARNESS = ROOT / "kernel" / "harness.c"
#: Sides of the grids, in vertices: one front, a few, and two lanes with a top.
SIDES = (1, 2, 5, 16, 31)
#: Plans with a wrong number that are run.
WRONG_PLANS = 60
#: Where this runs, and what it runs by an emulator.
HERE, EMULATED = "linux-x64", "linux-arm64"
SANITIZE = ("-g", "-O1", "-std=c11", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


def plan_of(rows: np.ndarray, cols: np.ndarray, plane: np.ndarray) -> KernelPlan:
    graph = vertex_graph(rows // 3, cols // 3, len(plane))
    return lay_out(analyse(graph, dissect(graph, plane)), rows, cols)


def random_graph(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows, cols and plane of vertices that are coupled without any order."""
    rng = np.random.default_rng(seed)
    size = 120
    pairs = np.concatenate([rng.integers(0, size, (300, 2)), np.repeat(np.arange(size)[:, None], 2, axis=1)])
    keys = np.unique(pairs.max(1) * size + pairs.min(1))
    c, d = np.divmod(np.arange(9), 3)
    rows = (3 * (keys // size)[:, None] + c).ravel()
    cols = (3 * (keys % size)[:, None] + d).ravel()
    lower = rows >= cols
    return rows[lower], cols[lower], rng.random((size, 2))


def with_a_wrong_number(plan: KernelPlan, rng: np.random.Generator) -> KernelPlan:
    """One number of an array made a little larger or smaller."""
    name = str(rng.choice(["fronts", "source", "target", "children", "runs", "indices"]))
    changed = getattr(plan, name).copy()
    flat = changed.view(changed.dtype[0]) if changed.dtype.names else changed
    flat[rng.integers(len(flat))] += rng.choice([-8, -3, -1, 1, 3, 8])
    return replace(plan, **{name: changed})


def wrong_plans(plan: KernelPlan) -> list[KernelPlan]:
    """Plans that differ from this one and are accepted all the same."""
    rng = np.random.default_rng(0)
    found: list[KernelPlan] = []
    while len(found) < WRONG_PLANS:
        changed = with_a_wrong_number(plan, rng)
        try:
            check(changed)
        except BrokenPlanError:
            continue
        found.append(changed)
    return found


def write_plan(plan: KernelPlan, values: np.ndarray, path: Path) -> None:
    """As kernel/harness.c reads it."""
    lists = [side for stage in plan.stages for side in stage]
    listed = np.concatenate(lists)
    counts = (plan.fronts, plan.source, plan.children, plan.runs, plan.indices, listed, lists)
    sizes = [*map(len, counts), plan.unknowns, plan.panels_size, plan.updates_size, plan.carried_size]
    arrays = [
        np.array([*sizes, plan.scratch_size], np.int64),
        *(plan.fronts, plan.source, plan.target, plan.children, plan.runs, plan.indices, listed),
        np.array([len(front_list) for front_list in lists], np.int64),
        *(values, np.cos(np.arange(plan.unknowns))),
    ]
    path.write_bytes(b"".join(array.tobytes() for array in arrays))


def write_plans(folder: Path) -> list[Path]:
    paths = []
    patterns = [*map(diamond_pattern, SIDES), *map(random_graph, range(3))]
    for rows, cols, plane in patterns:
        plan, values = plan_of(rows, cols, plane), dominant_values(rows, cols, 3 * len(plane))
        for wrong in [plan, *(wrong_plans(plan) if len(plane) == 16 * 16 else [])]:
            paths.append(folder / f"{len(paths)}.plan")
            write_plan(wrong, values, paths[-1])
    return paths


def run(command: list[str]) -> str:
    """What the harness prints. Ends this program when it fails, with what it said."""
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode != 0 or "differs" in ran.stdout:
        raise SystemExit(f"the kernel failed: {' '.join(command[:3])} …\n{ran.stdout[-2000:]}{ran.stderr[-4000:]}")
    return ran.stdout


def sanitized(folder: Path, plans: list[Path]) -> None:
    compiler = shutil.which("cc")
    if compiler is None:
        print("NOT CHECKED under sanitizers: there is no cc")
        return
    library, harness = folder / "sanitized.so", folder / "sanitized"
    source = str(kernel_wheels.SOURCES / "kernel.c")
    subprocess.run([compiler, *SANITIZE, "-shared", "-fPIC", source, "-o", str(library)], check=True)
    subprocess.run([compiler, *SANITIZE, str(HARNESS), "-o", str(harness), "-ldl"], check=True)
    run([str(harness), str(library), *map(str, plans)])
    print(f"sanitizers found nothing in {len(plans)} plans")


def harness_of(folder: Path, platform: str) -> list[str]:
    """The command that runs a platform's library on the plans that follow."""
    target = kernel_wheels.TARGETS[platform]
    if platform == EMULATED:
        # A program without a loader or a C library from outside: the kernel is linked into it.
        harness = folder / platform
        sources = [*map(str, (kernel_wheels.SOURCES / "kernel.c", HARNESS)), "-DKERNEL_LINKED", "-static"]
        flags = [flag for flag in kernel_wheels.FLAGS if flag not in ("-shared", "-nostdlib")]
        kernel_wheels.compile_with_zig("aarch64-linux-musl", [*sources, *flags], harness)
        return ["qemu-aarch64-static", str(harness), "linked"]
    library = folder / f"{platform}{target.suffix}"
    harness = folder / (f"{platform}.exe" if target.suffix == ".dll" else platform)
    kernel_wheels.compile_library(platform, library)
    kernel_wheels.compile_with_zig(target.zig, ["-O1", "-std=c11", str(HARNESS)], harness)
    return [*(["wine"] if target.suffix == ".dll" else []), str(harness), str(library)]


def checksums(command: list[str], plans: list[Path]) -> dict[str, set[str]]:
    """For each plan what the instruction sets gave."""
    found: dict[str, set[str]] = {}
    for line in run([*command, *map(str, plans)]).splitlines():
        if line.startswith("plan "):
            results = found.setdefault(line, set())
        else:
            results.add(line.split(" ", 2)[2])
    return found


def main() -> None:
    if kernel_wheels.this_platform() != HERE:
        raise SystemExit(f"the kernel can be checked on {HERE} only")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plans = write_plans(folder)
        sanitized(folder, plans)
        expected: dict[str, set[str]] = {}
        for platform, needs in ((HERE, None), ("windows-x64", "wine"), (EMULATED, "qemu-aarch64-static")):
            if needs is not None and shutil.which(needs) is None:
                print(f"NOT CHECKED on {platform}: there is no {needs}")
                continue
            found = checksums(harness_of(folder, platform), plans)
            expected = expected or found
            if found != expected or any(len(results) != 1 for results in found.values()):
                raise SystemExit(f"{platform} gives other bits: {found}")
            print(f"{platform}: {len(found)} plans, the same bits with every instruction set", flush=True)
        print("NOT CHECKED on macOS: it cannot be run here")


if __name__ == "__main__":
    main()
