"""From the handles of a paper, as Blender knows them, to what the solver is told."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils import Matrix, Vector  # type: ignore[import-not-found]
from numpy.typing import NDArray

from ...solver import Amount, Handle, Keep, Weights
from ...solver.controls.control import Control
from ...solver.description import LEAST_FOLD
from . import controls as crease_controls
from .curve_targets import target_points
from .evaluated_curves import line_strands

Point = tuple[float, float]

#: Targets that differ by less than this are the same, net units: rounding of matrices moves no paper.
SAME_TARGET = 1e-3
#: Handles nearer than this to each other hold one point, net units.
SAME_POINT = 1e-2
#: Angles that differ by less than this are the same, degrees.
_SAME_ANGLE = 1e-4
#: Numbers of controls that differ by less than this, or this part of them, are the same: their rounding.
_SAME_CONTROL = 1e-6
#: Numbers of one handle in ``Inputs.numbers``: at, target, axes, strength.
WIDTH = 9


@dataclass(frozen=True)
class Inputs:
    """What a paper is told. angle: degrees all creases are driven to, None without a drive.

    handles that act, in the paper's units, and their indices in the paper's settings
    controls: all else that is asked, and names: what the user calls each of them; weights: of the solver's terms
    least_fold: degrees by which creases fold at least where handles alone bend the paper
    faults: why others do not act, one sentence each
    """

    angle: float | None
    handles: tuple[Handle, ...] = ()
    indices: tuple[int, ...] = ()
    faults: tuple[str, ...] = ()
    controls: tuple[Control, ...] = ()
    names: tuple[str, ...] = ()
    weights: Weights = crease_controls.USUAL
    least_fold: float = LEAST_FOLD

    @property
    def asks(self) -> bool:
        """Whether some control may bend a flat sheet."""
        return any(not isinstance(control, Amount | Keep) for control in self.controls)

    @property
    def pulls(self) -> bool:
        """Whether anything may bend a flat sheet."""
        return bool(self.angle or self.handles or self.asks)

    def numbers(self) -> NDArray[np.float64]:
        """(2 + C + 9H,) angle (NaN for None), C and the numbers of the controls and weights, then at, target, axes
        and strength of each handle.
        """
        asked = crease_controls.numbers_of(self.controls, self.weights, self.least_fold)
        values = [math.nan if self.angle is None else self.angle, float(len(asked)), *asked]
        for handle in self.handles:
            values += [*handle.at, *handle.target, *map(float, handle.axes), handle.strength]
        return np.array(values)


def same(first: NDArray[np.float64] | None, second: NDArray[np.float64], unit: float) -> bool:
    """Whether two ``Inputs.numbers`` ask for the same shape. unit: the paper's units in one net unit."""
    if first is None or first.shape != second.shape or first[1] != second[1]:
        return False
    if math.isnan(first[0]) != math.isnan(second[0]) or abs(first[0] - second[0]) > _SAME_ANGLE:
        return False
    begin = handles_begin(first)
    if not np.allclose(first[2:begin], second[2:begin], _SAME_CONTROL, _SAME_CONTROL, equal_nan=True):
        return False
    gaps = np.abs(first[begin:] - second[begin:]).reshape(-1, WIDTH)
    return bool((gaps[:, :5] <= SAME_TARGET * unit).all() and (gaps[:, 5:] <= 1e-6).all())


def handles_begin(numbers: NDArray[np.float64]) -> int:
    """Where the handles begin in ``Inputs.numbers``."""
    return 2 + int(numbers[1])


def read(
    paper: Any,
    scene: Any,
    depsgraph: Any,
    unit: float,
    why_not_at: Callable[[Point], str],
    drawn: Sequence[crease_controls.DrawnCrease],
) -> Inputs:
    """What the paper object is told now. Values may be animated, so they are the evaluated ones.

    unit: the paper's units in one net unit; why_not_at: says why no handle can be at a point, or nothing; drawn:
    the creases.
    """
    mesh = paper.data
    settings = mesh.curvefold
    values = mesh.evaluated_get(depsgraph).curvefold
    if len(values.handles) != len(settings.handles):
        values = settings  # Blender evaluates nothing when an entry is taken away
    handles: list[Handle] = []
    indices: list[int] = []
    faults: list[str] = []
    for index, (entry, value) in enumerate(zip(settings.handles, values.handles, strict=True)):
        if not value.enabled or not any(value.axes):
            continue
        label = handle_label(settings, index)
        target = _target(entry, value, paper, scene, depsgraph)
        if target is None:
            faults.append(f"{label} is pulled by nothing any more: choose an object for it, or remove it")
            continue
        at = (float(entry.at[0]), float(entry.at[1]))
        reason = why_not_at(at)
        if reason:
            faults.append(f"{label}: {reason}")
            continue
        x, y, z = map(bool, value.axes)
        handle = Handle(at, target, (x, y, z), float(value.strength))
        twin = next((k for k, other in enumerate(handles) if math.dist(other.at, at) <= SAME_POINT * unit), None)
        if twin is not None:
            faults.append(f"{label} holds the same point as {handle_label(settings, indices[twin])}")
            continue
        handles.append(handle)
        indices.append(index)

    def curve_points(item: Any) -> tuple[crease_controls.Place, ...]:
        return target_points(
            item,
            scene,
            lambda curve: hook_matrix(curve, paper, depsgraph),
            lambda curve: line_strands(curve, depsgraph),
        )

    return with_controls(settings, values, tuple(handles), drawn, curve_points, tuple(indices), tuple(faults))


def with_controls(
    settings: Any,
    values: Any,
    handles: tuple[Handle, ...],
    drawn: Sequence[crease_controls.DrawnCrease],
    target: crease_controls.TargetReader,
    indices: tuple[int, ...] = (),
    faults: tuple[str, ...] = (),
) -> Inputs:
    """What a paper with such settings, kept and evaluated, and such handles is told."""
    told = crease_controls.told(settings, values, bool(handles), drawn, target)
    return Inputs(
        told.angle,
        handles,
        indices,
        (*faults, *told.faults),
        told.controls,
        told.names,
        told.weights,
        told.least_fold,
    )


def handle_label(settings: Any, index: int) -> str:
    """What messages call a handle."""
    return settings.handles[index].name or f"Handle {index + 1}"


def hook_matrix(hook: Any, paper: Any, depsgraph: Any) -> Matrix:
    """The hook's frame in the paper's local coordinates.

    A hook that rides on the paper is read without the world: then moving the paper is no motion at all, not even
    by rounding, and a hook that is switched off in viewports (its world matrix is not kept) is read all the same.
    """
    seen = hook.evaluated_get(depsgraph)
    rides = hook.parent == paper and hook.parent_type == "OBJECT" and not len(hook.constraints)
    if rides and hook.rigid_body is None:
        return seen.matrix_parent_inverse @ seen.matrix_basis
    return paper.evaluated_get(depsgraph).matrix_world.inverted_safe() @ seen.matrix_world


def offset_in(hook: Any, paper: Any, depsgraph: Any, place: Any) -> Vector:
    """A place of the paper's local coordinates in the hook's own."""
    return hook_matrix(hook, paper, depsgraph).inverted_safe() @ Vector(place)


def is_animated(paper: Any) -> bool:
    """Whether something other than a hand may move the hooks or the fold: then frames count."""
    mesh = paper.data
    if mesh.animation_data is not None or _moves(paper):
        return True
    things = movers(mesh.curvefold)
    return any(map(_moves, things)) or any(shape.animation_data is not None for shape in shapes_of(things))


def movers(settings: Any) -> list[Any]:
    """The objects whose places and shapes move the paper."""
    hooks = [entry.hook for entry in settings.handles if entry.hook is not None]
    curves = [entry.curve for entry in settings.creases if entry.flow == "OBJECT" and entry.curve is not None]
    return [*hooks, *curves, *(thing for curve in curves for thing in _used_by_modifiers(curve))]


def shapes_of(things: Sequence[Any]) -> list[Any]:
    """The datablocks that give the curves among ``things`` their shapes."""
    curves = [thing.data for thing in things if thing.type == "CURVE"]
    return [*curves, *(data.shape_keys for data in curves if data.shape_keys is not None)]


def _used_by_modifiers(thing: Any) -> list[Any]:
    """The objects that the modifiers of an object look at."""
    named = [
        getattr(modifier, field.identifier)
        for modifier in thing.modifiers
        for field in modifier.bl_rna.properties
        if field.type == "POINTER" and field.fixed_type.identifier == "Object"
    ]
    return [other for other in named if other is not None]


def _moves(thing: Any) -> bool:
    while thing is not None:
        if thing.animation_data is not None or len(thing.constraints) or thing.rigid_body is not None:
            return True
        thing = thing.parent
    return False


def _target(entry: Any, value: Any, paper: Any, scene: Any, depsgraph: Any) -> tuple[float, float, float] | None:
    """In the paper's local coordinates; None when the hook is gone."""
    if entry.hook is None:
        return _triple(value.offset) if entry.pinned else None
    # An object that was deleted lives on as long as a handle names it, but in no scene.
    if entry.hook.name not in scene.objects:
        return None
    return _triple(hook_matrix(entry.hook, paper, depsgraph) @ value.offset)


def _triple(vector: Any) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
