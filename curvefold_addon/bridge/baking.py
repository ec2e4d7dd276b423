"""Shapes of a paper over time as absolute shape keys: plain Blender, played without the solver."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Marks shape keys that were baked.
_BAKED = "curvefold_baked"


def shown_positions(mesh: Any) -> NDArray[np.float32]:
    """Flat (3R,) vertex positions."""
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", values)
    return values


def store_keys(paper: Any, shapes: Sequence[NDArray[np.float32]], first_frame: int) -> None:
    """One shape key a frame, played in their order by the evaluation time."""
    blocks = []
    for number, shape in enumerate(shapes):
        block = paper.shape_key_add(name=f"Frame {first_frame + number}", from_mix=False)
        block.data.foreach_set("co", shape)
        blocks.append(block)
    keys = paper.data.shape_keys
    keys.use_relative = False
    keys[_BAKED] = True
    for block in blocks:
        block.interpolation = "KEY_LINEAR"
    ends = ((first_frame, blocks[0].frame), (first_frame + len(shapes) - 1, blocks[-1].frame))
    for frame, time in ends:
        keys.eval_time = time
        keys.keyframe_insert("eval_time", frame=frame)
    make_linear(keys)


def is_baked(mesh: Any) -> bool:
    """Whether the mesh has shape keys of ours."""
    return mesh.shape_keys is not None and bool(mesh.shape_keys.get(_BAKED, False))


def leave_keys(mesh: Any) -> None:
    """Baked shape keys become the user's own."""
    if is_baked(mesh):
        del mesh.shape_keys[_BAKED]


def remove_keys(paper: Any) -> None:
    """Takes the shape keys away again."""
    paper.data.shape_keys.animation_data_clear()
    paper.shape_key_clear()


def make_linear(owner: Any) -> None:
    """Lets the animation of a datablock go evenly from key to key."""
    for curve in curves_of(owner):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def curves_of(owner: Any) -> list[Any]:
    """The animation curves of a datablock."""
    data = owner.animation_data
    action = None if data is None else data.action
    if action is None:
        return []
    if hasattr(action, "layers") and action.layers:
        # Actions in layers, from Blender 4.4 on; the flat list is gone from 5.0 on.
        bag = action.layers[0].strips[0].channelbag(data.action_slot)
        return [] if bag is None else list(bag.fcurves)
    return list(getattr(action, "fcurves", ()))
