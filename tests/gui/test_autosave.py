"""Blender goes on saving automatically: while a paper lies still, and after a drag."""

from __future__ import annotations

import time

from tests.gui.person import beside, grab, let_go, paper, settled
from tests.gui.program import Program

#: Blender's shortest interval, and how long is waited for what is due after it, seconds.
MINUTE = 60.0
PATIENCE = 60.0


def saved_at(blender: Program) -> float:
    """When Blender has last saved by itself; 0 for never."""
    times = [path.stat().st_mtime for path in (blender.work / "tmp").glob("*autosave*.blend")]
    return max(times, default=0.0)


def next_save(blender: Program, after: float) -> float:
    """Waits for it."""
    end = time.time() + MINUTE + PATIENCE
    while saved_at(blender) <= after:
        assert time.time() < end, "Blender has stopped saving automatically"
        time.sleep(1.0)
    return saved_at(blender)


def test_an_idle_paper_lets_blender_save(blender: Program) -> None:
    blender.ask("prepare", sample="one_arc", resolution=24, points=[[0.05, 0.95], [0.95, 0.95]])
    settled(blender)
    blender.ask("save_automatically", minutes=1)
    start = time.time()
    first = next_save(blender, start)
    print(f"\n  idle: saved after {first - start:.0f} s")


def test_a_dragged_paper_lets_blender_save(blender: Program, shot) -> None:
    hook = paper(blender.facts())["hooks"][0]
    before = saved_at(blender)
    start = grab(blender, hook)
    blender.screen.glide(start, beside(start, 20.0, 60.0), 2.0)
    let_go(blender)
    after = settled(blender)
    shot("autosave")
    assert after["modal"] == []
    dragged = time.time()
    print(f"  after a drag: saved after {next_save(blender, max(before, dragged)) - dragged:.0f} s")
