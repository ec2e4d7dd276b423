"""Which drawing a command is about, and who has to know when it has changed."""

from collections.abc import Iterable, Sequence

import bpy

from .. import solver
from . import live
from .bridge import drawing_objects, linked, state
from .bridge.papers import is_paper


def active_sheet(context: bpy.types.Context) -> bpy.types.Object | None:
    """The sheet that is meant: the active object, that of the active crease or paper, the one that is selected,
    or the only one of the scene."""
    active = context.active_object
    if active is not None:
        found = _sheet_behind(active)
        if found is not None and not drawing_objects.is_deleted(found):
            return found
    for group in (context.selected_objects, context.scene.objects):
        sheets = [item for item in group if drawing_objects.is_sheet(item)]
        if sheets:
            return sheets[0] if len(sheets) == 1 else None
    return None


def meant_sheets(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The sheets that papers are made of: all that are selected where the active one is among them, or none is
    active; of several, those that have no paper yet, if there are any.
    """
    active = active_sheet(context)
    selected = [item for item in context.selected_objects if drawing_objects.is_sheet(item)]
    if len(selected) < 2 or (active is not None and active not in selected):
        return [] if active is None else [active]
    return [sheet for sheet in selected if not live.papers_on(sheet)] or selected


def _sheet_behind(item: bpy.types.Object) -> bpy.types.Object | None:
    if is_paper(item):
        return item.data.curvefold.sheet
    return drawing_objects.sheet_of(item)


def meant_paper(context: bpy.types.Context) -> bpy.types.Object | None:
    """The active paper, else the first by name that follows the active sheet; None when there is none."""
    return live.active_paper(context) or next(iter(live.papers_on(active_sheet(context))), None)


def papers_of(sheet: bpy.types.Object) -> list[bpy.types.Mesh]:
    """The papers that are folded along a sheet's drawing."""
    return [mesh for mesh in bpy.data.meshes if mesh.curvefold.is_paper and mesh.curvefold.sheet == sheet]


def drawing_changed(sheet: bpy.types.Object) -> list[str]:
    """Lets the papers follow; without a window they are folded before this returns.

    One sentence for each that cannot be folded.
    """
    problems = []
    for mesh in papers_of(sheet):
        live.rebuild(mesh)
        if bpy.app.background and mesh.curvefold.live:
            try:
                live.settle(mesh)
            except (solver.CurvefoldError, state.StateError) as error:
                problems.append(f"{mesh.name}: {error}")
    return problems


def select_only(context: bpy.types.Context, first: bpy.types.Object, *others: bpy.types.Object) -> None:
    """Makes an object the active one, and it and others the only selected ones."""
    for item in context.selected_objects:
        item.select_set(False)
    for item in (first, *others):
        item.select_set(True)
    context.view_layer.objects.active = first


def in_object_mode(operator: type, context: bpy.types.Context) -> bool:
    """For polls: says so when it is not."""
    if context.mode == "OBJECT":
        return True
    operator.poll_message_set("Works in Object Mode")
    return False


def may_change(operator: type, item: bpy.types.Object) -> bool:
    """For polls: says so when an object is linked, so that no change of it would be saved."""
    reason = linked.why_not_this(item)
    if reason:
        operator.poll_message_set(reason)
    return not reason


def may_change_some(operator: type, items: Sequence[bpy.types.Object]) -> bool:
    """For polls: says so when all objects are linked."""
    return any(not linked.why_not_this(item) for item in items) or may_change(operator, items[0])


def changeable(operator: bpy.types.Operator, items: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    """Those of the objects that are not linked; of each that is, the user is told."""
    found = []
    for item in items:
        reason = linked.why_not_this(item)
        if reason:
            operator.report({"WARNING"}, reason)
        else:
            found.append(item)
    return found


NO_SHEET = "Select a paper sheet, or something on it"
