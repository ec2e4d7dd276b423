"""The objects of a drawing: how sheets and creases are made, marked, found and told apart by eye."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import bpy

from . import linked

SHEET, CREASE = "SHEET", "CREASE"

Color = tuple[float, float, float, float]

#: Name of the look and its scene-linear colour, for FOLD's letters.
LOOKS: dict[str, tuple[str, Color]] = {
    "M": ("Curvefold Mountain", (1.0, 0.08, 0.05, 1.0)),
    "V": ("Curvefold Valley", (0.06, 0.30, 1.0, 1.0)),
    "U": ("Curvefold Free Crease", (0.72, 0.36, 1.0, 1.0)),
    "F": ("Curvefold Flat Crease", (0.45, 0.45, 0.45, 1.0)),
}


def new_curve(name: str) -> Any:
    """A planar Curve datablock that shows lines and no faces."""
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions = "2D"
    curve.fill_mode = "NONE"
    # As fine as a paper that follows it.
    curve.resolution_u = 24
    return curve


def remove_curve(curve: Any) -> None:
    """Takes back ``new_curve``."""
    bpy.data.curves.remove(curve)


def new_sheet(curve: Any, collection: Any) -> Any:
    """A sheet whose border is ``curve``, at the world's origin."""
    sheet = bpy.data.objects.new(curve.name, curve)
    collection.objects.link(sheet)
    mark_sheet(sheet)
    return sheet


def mark_sheet(sheet: Any) -> None:
    """Makes a Curve object a sheet."""
    sheet.curvefold.role = SHEET
    make_thin(sheet.data)
    # A drawing is a tool, not a part of the picture.
    sheet.hide_render = True


def new_crease(curve: Any, sheet: Any, assignment: str) -> Any:
    """A crease of a sheet, in the sheet's own coordinates."""
    crease = bpy.data.objects.new(curve.name, curve)
    for collection in linked.homes_beside(sheet):
        collection.objects.link(crease)
    crease.parent = sheet
    mark_crease(crease, assignment)
    return crease


def mark_crease(crease: Any, assignment: str) -> None:
    """Makes a Curve object a crease of its parent.

    It gets no thickness, which would count in its size; its colour is seen in the overlays.
    """
    crease.curvefold.role = CREASE
    crease.curvefold.assignment = assignment
    crease.hide_render = True
    make_thin(crease.data)
    show_assignment(crease)


def show_assignment(crease: Any) -> None:
    """Colours a crease as its assignment says."""
    name, color = LOOKS[crease.curvefold.assignment]
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.diffuse_color = color
    crease.color = color
    if not crease.data.materials:
        crease.data.materials.append(None)
    # On the object: creases that share a curve may differ.
    slot = crease.material_slots[0]
    slot.link = "OBJECT"
    slot.material = material


def keep_notes(settings: Any, notes: Sequence[str]) -> None:
    """Keeps what was decided when a drawing was read with what was made of it, a line each."""
    settings.notes = "\n".join(notes).encode("utf-8", "backslashreplace").decode("utf-8")


def drop_dots(curve: Any) -> None:
    """Removes the splines of one point from a Curve datablock that is not being edited: a click leaves one."""
    if curve.is_editmode or curve.shape_keys is not None or not curve.is_editable:
        return
    for spline in list(curve.splines):
        points = spline.bezier_points if spline.type == "BEZIER" else spline.points
        if len(points) < 2:
            curve.splines.remove(spline)


def make_thin(curve: Any) -> None:
    """Gives the points of a Curve datablock no radius: Blender counts it in the size of what it frames, although
    nothing shows it. What has a thickness of its own keeps it.
    """
    if curve.bevel_depth != 0.0 or curve.bevel_mode != "ROUND" or curve.extrude != 0.0 or not curve.is_editable:
        return
    for spline in curve.splines:
        points = spline.bezier_points if spline.type == "BEZIER" else spline.points
        points.foreach_set("radius", [0.0] * len(points))


def is_sheet(candidate: Any) -> bool:
    return bool(candidate.curvefold.role == SHEET)


def is_crease(candidate: Any) -> bool:
    return bool(candidate.curvefold.role == CREASE)


def is_part(candidate: Any) -> bool:
    """Whether an object is a part of a drawing, sheet or crease."""
    return is_sheet(candidate) or is_crease(candidate)


def sheet_of(item: Any) -> Any:
    """The sheet that an object is, or lies on, directly or below other objects; None when there is none."""
    node = item
    while node is not None and not is_sheet(node):
        node = node.parent
    return node


def is_deleted(item: Any) -> bool:
    """Whether an object is in no scene any more; what refers to it, as papers do to their sheet, keeps it."""
    return not item.users_scene


def has_lost_sheet(crease: Any) -> bool:
    """Whether an object is a crease whose sheet was deleted, or from which it was taken."""
    if not is_crease(crease):
        return False
    sheet = sheet_of(crease)
    return sheet is None or is_deleted(sheet)


def creases_of(sheet: Any) -> list[Any]:
    """The crease objects of a sheet, by name (2 before 10), leaving out deleted ones."""
    below = [child for child in sheet.children_recursive if is_crease(child) and sheet_of(child) == sheet]
    scenes = sheet.users_scene
    if scenes:
        # An object that something else still refers to outlives its deletion, but in no scene.
        present = {item for scene in scenes for item in scene.objects}
        below = [child for child in below if child in present]
    return sorted(below, key=lambda child: _natural(child.name))


def _natural(name: str) -> list[tuple[int, str]]:
    """Sorts numbers by value."""
    parts = re.split(r"(\d+)", name)
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in parts]
