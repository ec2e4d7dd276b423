"""What is folded in a window and without one, as exact bits to compare. Runs inside the Blender under test.

Without a window: ``blender --background --python bits.py -- DRAWING FILE`` writes them all to a JSON file.
"""

import hashlib
import json
import sys
from pathlib import Path

import bpy
import numpy as np
from bpy.app.handlers import persistent

SAMPLE = "two_parallel_arcs"
RESOLUTION = 16
#: Per cent of the whole angle.
FOLD = 70.0
#: Frames of an animation, and the fold at its ends.
FRAMES = 8
FOLDS = (20.0, 60.0)
#: Where its two handles are on the sheet, from 0 to 1 each way, and how far the second one is moved, units.
POINTS = ((0.05, 0.95), (0.95, 0.05))
MOVE = (-0.01, 0.01, 0.02)


def digest(mesh: bpy.types.Mesh) -> str:
    """Of the net's exact coordinates."""
    return hashlib.sha256(np.frombuffer(mesh["curvefold_positions"], dtype=np.float64).tobytes()).hexdigest()


def shown(mesh: bpy.types.Mesh) -> np.ndarray:
    """What the mesh shows: (V, 3)."""
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def new_paper(sample: str, resolution: int, points: list[list[float]]) -> bpy.types.Object:
    """A sample's paper in an empty scene, with handles near points of the sheet, from 0 to 1 each way."""
    for thing in list(bpy.context.scene.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.curvefold.add_sample(sample=sample)
    bpy.ops.curvefold.make_paper(resolution=resolution)
    paper = bpy.context.object
    places = shown(paper.data)
    low, high = places.min(axis=0), places.max(axis=0)
    if not points:
        return paper
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for point in points:
        wanted = low[:2] + np.array(point) * (high - low)[:2]
        nearest = np.argmin(np.linalg.norm(places[:, :2] - wanted, axis=1))
        paper.data.vertices[int(nearest)].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curvefold.add_handles(together=False)
    return paper


def waited_for() -> str:
    """A fold that the operator waits for."""
    paper = new_paper(SAMPLE, RESOLUTION, [])
    paper.data.curvefold.fold = FOLD
    bpy.ops.curvefold.settle()
    return digest(paper.data)


def at_once(drawing: str) -> str:
    """A drawing that is imported folded."""
    bpy.ops.curvefold.fold_drawing(filepath=drawing, resolution=RESOLUTION)
    return digest(bpy.context.object.data)


def animated() -> bpy.types.Object:
    """A paper whose fold and one of whose handles are keyframed, at its first frame."""
    scene = bpy.context.scene
    paper = new_paper(SAMPLE, RESOLUTION, POINTS)
    hook = paper.data.curvefold.handles[-1].hook
    scene.frame_start, scene.frame_end = 1, FRAMES
    start = np.array(hook.location)
    for frame, fold, part in ((1, FOLDS[0], 0.0), (FRAMES, FOLDS[1], 1.0)):
        paper.data.curvefold.fold = fold
        paper.data.keyframe_insert("curvefold.fold", frame=frame)
        hook.location = start + part * np.array(MOVE)
        hook.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    return paper


#: Digests of every frame that was shown since ``watch_frames``, with the frame's number.
_seen: list[list] = []
_watched = ""


def watch_frames(paper: str) -> None:
    global _watched
    _watched = paper
    _seen.clear()


def seen_frames() -> list[list]:
    return _seen


@persistent
def _frame(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    paper = bpy.data.objects.get(_watched)
    if paper is not None:
        _seen.append([scene.frame_current, digest(paper.data)])


def watch() -> None:
    """After the extension's own handler, which is there already."""
    bpy.app.handlers.frame_change_post.append(_frame)


def _main(drawing: str, target: str) -> None:
    watch()
    found = {"waited_for": waited_for(), "at_once": at_once(drawing)}
    watch_frames(animated().name)
    for frame in range(1, FRAMES + 1):
        bpy.context.scene.frame_set(frame)
    found["frames"] = _seen
    Path(target).write_text(json.dumps(found))


if __name__ == "__main__":
    _main(*sys.argv[sys.argv.index("--") + 1 :])
