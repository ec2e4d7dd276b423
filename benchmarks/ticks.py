"""How long ticks take in Blender's own thread, whatever a hand does: ``PYTHON -m benchmarks.ticks`` in bpy.

    "$(scripts/setup.sh bpy 5.0.1)" -m benchmarks.ticks [--resolutions 36 58] [--only NAME …] [--profile NAME]

A paper with two handles follows what a hand does, 300 ticks with a pause between them as for drawing. Shown is how
long ticks took, and changes (what operators and handlers do at once, Blender's own update included). A view is
never held up for longer than twice the budget when no tick is longer. Figures for reading; nothing is asserted.
"""

from __future__ import annotations

import argparse
import cProfile
import importlib
import math
import os
import pstats
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from curvefold_addon import checkout

ROOT = Path(__file__).absolute().parents[1]
SAMPLE = "two_parallel_arcs"
#: Resolutions for about 1,600 and 3,900 vertices.
RESOLUTIONS = (36, 58)
TICKS = 300
#: Between two ticks, seconds: a frame is drawn.
PAUSE = 0.02
#: What a tick may take at most, seconds: twice the extension's default budget.
LONGEST = 0.04

#: What is done before tick k; whether the hand still holds something.
Hand = Callable[[int], bool]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--resolutions", type=int, nargs="+", default=RESOLUTIONS)
    parser.add_argument("--only", nargs="+", default=list(HANDS), choices=list(HANDS), metavar="NAME")
    parser.add_argument(
        "--profile", action="store_true", help="show where the ticks over the bound spend their time"
    )
    arguments = parser.parse_args()
    print("| vertices | what a hand does | ticks: median | 99 % | longest | over 40 ms | changes: longest |  (ms)")
    print("| --: | --- | --: | --: | --: | --: | --: |")
    for resolution in arguments.resolutions:
        for name in arguments.only:
            bench = Bench(resolution)
            bench.run(HANDS[name](bench), arguments.profile)
            print(f"| {len(bench.session.net.rest):,} | {name} | {bench.row()} |", flush=True)
            bench.show_profile()


class Bench:
    """A paper that rests, folded by half, with two handles."""

    def __init__(self, resolution: int) -> None:
        import bpy

        self.bpy = bpy
        self.live = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.live")
        self.making = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.handle_making")
        self.points = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.bridge.surface_points")
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.ops.curvefold.add_sample(sample=SAMPLE)
        bpy.ops.curvefold.make_paper(resolution=resolution)
        self.paper = bpy.context.object
        self.mesh = self.paper.data
        self.sheet = self.mesh.curvefold.sheet
        self.mesh.curvefold.fold = 50.0
        self.live.settle(self.mesh)
        self.add_handle(0.05, 0.95)
        self.empty = self.add_handle(0.95, 0.05)
        self.live.settle(self.mesh)
        self.follow = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.operators.follow")
        self._held: list[Any] = []  # the operators that Blender runs beside
        self._operator = SimpleNamespace(_ended=0.0, cancel=lambda context: self.follow.stop(self._manager))
        self._manager = SimpleNamespace(
            windows=[SimpleNamespace(modal_operators=self._held)],
            event_timer_add=lambda step, window: step,
            event_timer_remove=lambda timer: None,
            modal_handler_add=lambda operator: None,
        )
        self.changes: list[float] = []
        self.ticks: list[float] = []
        self._profiles: list[cProfile.Profile] = []

    @property
    def session(self) -> Any:
        return self.live.make_session(self.paper)

    def add_handle(self, right: float, up: float) -> Any:
        """A handle and its empty as a click makes them, at parts of the flat sheet's sides."""
        flat = self.session.net.rest
        low, high = flat.min(axis=0), flat.max(axis=0)
        at = tuple((low + (right, up) * (high - low)).tolist())
        point = self.points.SurfacePoint(at, self.session.place_of(at))
        handle = self.making.add_handle(self.paper, point)
        empty = self.making.new_empty(self.paper, point.place, handle.name)
        self.making.hook_to(handle, self.paper, empty)
        self.live.wake(self.mesh)
        return empty

    def run(self, hand: Hand, profiled: bool) -> None:
        for k in range(TICKS):
            begin = time.perf_counter()
            held = hand(k)
            self.bpy.context.view_layer.update()
            middle = time.perf_counter()
            profile = cProfile.Profile() if profiled else None
            if profile is None:
                self._tick(held)
            else:
                profile.runcall(self._tick, held)
            end = time.perf_counter()
            self.changes.append(middle - begin)
            self.ticks.append(end - middle)
            if profile is not None and end - middle > LONGEST:
                self._profiles.append(profile)
            time.sleep(PAUSE)
        self.follow.stop(self._manager)
        assert np.isfinite(self.session.positions).all()

    def _tick(self, held: bool) -> None:
        """A timer event for the operator that follows, which begins and ends as it does in a window."""
        context = SimpleNamespace(window_manager=self._manager, window=None)
        if self.live.is_at_work():
            self.follow.Follow.invoke(self._operator, context, None)
        if self.follow._running:
            self._held[:] = [SimpleNamespace(bl_idname="TRANSFORM_OT_translate")] * held
            self.follow.Follow.modal(self._operator, context, SimpleNamespace(type="TIMER"))

    def row(self) -> str:
        ticks, changes = 1e3 * np.array(self.ticks), 1e3 * np.array(self.changes)
        figures = (np.median(ticks), np.quantile(ticks, 0.99), ticks.max())
        over = np.count_nonzero(ticks > 1e3 * LONGEST)
        return " | ".join([*(f"{figure:.1f}" for figure in figures), str(over), f"{changes.max():.1f}"])

    def show_profile(self) -> None:
        if self._profiles:
            slow = [f"{k}: {1e3 * t:.0f}" for k, t in enumerate(self.ticks) if t > LONGEST]
            print("ticks over the bound, ms:", ", ".join(slow))
            pstats.Stats(*self._profiles).sort_stats("cumulative").print_stats(25)


def drag(bench: Bench) -> Hand:
    """An empty goes to and fro."""
    start = bench.empty.location.copy()
    size = max(bench.paper.dimensions)

    def move(k: int) -> bool:
        bench.empty.location.z = start.z + 0.15 * size * math.sin(k / 20.0)
        bench.empty.location.x = start.x - 0.15 * size * math.sin(k / 20.0) ** 2
        return True

    return move


def edit(bench: Bench) -> Hand:
    """A point of a crease is moved in Edit Mode for a while and let go, again and again: the net is made anew."""
    bpy = bench.bpy
    crease = next(item for item in bench.sheet.children if item.type == "CURVE")
    bench.paper.select_set(False)
    crease.select_set(True)
    bpy.context.view_layer.objects.active = crease
    bpy.ops.object.mode_set(mode="EDIT")
    spline = crease.data.splines[0]
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    point = points[len(points) // 2]
    start = point.co.copy()
    size = max(bench.paper.dimensions)

    def move(k: int) -> bool:
        held = k % 75 < 20
        if held:
            point.co.y = start.y + 0.02 * size * math.sin(k / 9.0)
            crease.data.update_tag()
        return held

    return move


def resolution(bench: Bench) -> Hand:
    """The resolution goes up and down, a new net each time."""
    first = bench.mesh.curvefold.resolution

    def change(k: int) -> bool:
        if k % 75 == 0:
            bench.mesh.curvefold.resolution = first - (k // 75) % 2
        return False

    return change


def handles(bench: Bench) -> Hand:
    """A handle more every 25 ticks, and the one before is pulled."""

    def add(k: int) -> bool:
        if k % 25 == 0:
            bench.empty = bench.add_handle(0.1 + 0.065 * (k // 25), 0.3 + 0.03 * (k // 25))
        elif k % 25 > 5:
            bench.empty.location.z += 1e-4
        return False

    return add


def sides(bench: Bench) -> Hand:
    """A crease is held to one side, to the other, and set free."""

    def flip(k: int) -> bool:
        if k % 40 == 0:
            bench.mesh.curvefold.creases[0].side = "VMU"[k // 40 % 3]
        return False

    return flip


def angles(bench: Bench) -> Hand:
    """A crease gets an angle of its own, and loses it."""

    def give(k: int) -> bool:
        entry = bench.mesh.curvefold.creases[0]
        if k % 40 == 0:
            entry.use_angle = not entry.use_angle
        entry.amount = 50.0 + 25.0 * math.sin(k / 15.0)
        return False

    return give


def slider(bench: Bench) -> Hand:
    """The slider Fold is dragged."""

    def slide(k: int) -> bool:
        bench.mesh.curvefold.fold = 50.0 + 40.0 * math.sin(k / 30.0)
        return False

    return slide


def undo(bench: Bench) -> Hand:
    """What undo and redo leave: every session looks again at what its datablocks carry."""

    def step(k: int) -> bool:
        if k % 30 == 0:
            bench.live.park()
        bench.empty.location.z += 1e-4
        return False

    return step


def opened(bench: Bench) -> Hand:
    """The paper is asked for anew, as after a file was opened."""

    def forget(k: int) -> bool:
        if k % 60 == 0:
            bench.live.forget()
            bench.live.wake_all()
        bench.empty.location.z += 1e-4
        return False

    return forget


#: The hands by name.
HANDS: dict[str, Callable[[Bench], Hand]] = {
    "an empty dragged": drag,
    "a crease edited": edit,
    "another resolution": resolution,
    "handles added": handles,
    "a crease's side": sides,
    "a crease's angle": angles,
    "the slider": slider,
    "undo": undo,
    "opened": opened,
}

if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="curvefold-ticks-", ignore_cleanup_errors=True) as folder:
        checkout.link(ROOT, Path(folder))
        checkout.enable(Path(folder))
        main()
    sys.stdout.flush()
    # Blender's own clean-up at exit may crash or hang.
    os._exit(0)
