"""How closely papers of 2,000 and 4,000 vertices follow a hand: figures for out/gui/following.json, not bounds."""

from __future__ import annotations

import json
import os
from dataclasses import asdict

import numpy as np
import pytest

from tests.gui.conftest import OUT
from tests.gui.following import following, spending
from tests.gui.person import grab, let_go, paper, settled
from tests.gui.program import Program
from tests.gui.screen import MOUSE_STEP

SAMPLE = "two_parallel_arcs"
#: The smallest window: here a processor draws it, and that should not be what is measured.
WINDOW = (640, 480)
#: The hand goes to and fro and stops: at most this part of the way to the other handle, where paper can follow it.
PART = 0.4
SECONDS = 6.0


@pytest.mark.parametrize(("name", "resolution"), [("2000", 41), ("4000", 59)])
def test_following(blender: Program, shot, name: str, resolution: int) -> None:
    blender.ask("prepare", sample=SAMPLE, resolution=resolution, points=[[0.03, 0.97], [0.97, 0.03]])
    facts = settled(blender)
    hook, other = paper(facts)["hooks"]
    (label,) = facts["papers"]
    blender.ask("record", paper=label, hook=hook)
    start = grab(blender, hook)
    before = blender.processor_seconds()
    end = blender.place(facts["objects"][other]["place"])
    parts = PART * np.sin(3.5 * np.pi * np.arange(0.0, SECONDS, MOUSE_STEP) / SECONDS) ** 2
    blender.screen.follow([tuple((1.0 - part) * np.array(start) + part * np.array(end)) for part in parts])
    now = blender.processor_seconds()
    threads = {name: round(now[name] - before.get(name, 0.0), 2) for name in now}
    threads = {name: seconds for name, seconds in threads.items() if seconds > 0.1}
    shot(f"speed-{name}")
    let_go(blender)
    after = settled(blender)
    events = blender.ask("recorded")["events"]
    found, spent = following(events), spending(events)
    assert paper(after)["finite"]
    vertices = paper(after)["report"]["vertices"]
    load = os.getloadavg()[0]
    print(f"\n  {vertices} vertices: {found} (load {load:.1f} on {os.cpu_count()} cores, software renderer)")
    print(f"  milliseconds in a frame: {spent}")
    print(f"  processor seconds by threads: {threads}")
    path = OUT / "following.json"
    figures = json.loads(path.read_text()) if path.exists() else {}
    figures[name] = asdict(found) | {
        "spending": asdict(spent),
        "vertices": vertices,
        "load": load,
        "cores": os.cpu_count(),
    }
    path.write_text(json.dumps(figures, indent=1))
