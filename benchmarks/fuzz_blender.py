"""Lets hostile input in by the doors that only Blender has: curve objects and batches.

Run it with a bpy module: "$(scripts/setup.sh bpy 5.0.1)" -m benchmarks.fuzz_blender [--count 20000] [--seed 0]
[--door curves batch]. Counts what benchmarks.fuzz counts.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from benchmarks.fuzz_batch import batch_door
from benchmarks.fuzz_curves import made_drawing
from benchmarks.fuzz_run import Door, run
from curvefold_addon import checkout

ROOT = Path(__file__).absolute().parents[1]

#: A module of the enabled extension, by its name.
Extension = Callable[[str], ModuleType]


def doors(extension: Extension) -> dict[str, Door]:
    return {"curves": curves_door(extension), "batch": batch_door(extension)}


def curves_door(extension: Extension) -> Door:
    """Curve objects as drawings: read, made a paper of, and changed while the paper follows."""
    refusals = (extension("solver").CurvefoldError,)
    return Door(made_drawing, _Drawing(extension).use, refusals, frozenset())


class _Drawing:
    """Makes what is told, as a user could, and a paper of it."""

    def __init__(self, extension: Extension) -> None:
        self._live = extension("curvefold_addon.live")
        self._handlers = extension("curvefold_addon.handlers")
        self._drawing = extension("curvefold_addon.bridge.drawing")
        self._objects = extension("curvefold_addon.bridge.drawing_objects")
        self._state = extension("curvefold_addon.bridge.state")
        self._refusal = extension("solver").CurvefoldError

    def use(self, data: bytes, folder: Path) -> None:
        import bpy

        told = json.loads(data)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self._handlers._said.clear()
        bpy.context.scene.unit_settings.scale_length = told["unit"]
        sheet = self._made_sheet(told)
        for item in told["creases"]:
            self._make_crease(item, sheet)
        if told["shown"]:
            bpy.context.view_layer.update()
        for trouble in self._drawing.troubles(sheet) if told["looked_at"] else ():
            if len(trouble.sentence.splitlines()) != 1:
                raise AssertionError(f"not one line: {trouble.sentence}")
        if told["made"]:
            select(sheet)
            call(bpy.ops.curvefold.make_paper, resolution=told["resolution"])
        papers = [item for item in bpy.data.objects if item.type == "MESH" and item.data.curvefold.is_paper]
        for paper in papers:
            if "later" in told or "later_border" in told:
                self._follow(paper.data, sheet, told)
            kept = self._state.load(paper.data)
            if not np.isfinite(kept.positions).all():
                raise AssertionError("the numbers ran away")
        if not papers:
            self._drawing.read_drawing(sheet)  # and says why
        if self._handlers._said or self._live._broken:
            raise AssertionError(f"unseen: {self._handlers._said} {self._live._broken}")

    def _follow(self, mesh: Any, sheet: Any, told: dict[str, Any]) -> None:
        """The drawing changes under a paper."""
        if "later" in told:
            self._make_crease(told["later"], sheet)
        if "later_border" in told and sheet.type == "CURVE":
            sheet.data.splines.clear()
            add_splines(sheet.data, told["later_border"]["splines"])
        self._live.rebuild(mesh)
        try:
            self._live.settle(mesh)
        except self._refusal:
            return  # the paper stays as it was

    def _made_sheet(self, told: dict[str, Any]) -> Any:
        import bpy

        sheet = made_object("Sheet", told["sheet"])
        if told["sheet_from_object"]:
            select(sheet)
            call(bpy.ops.curvefold.sheet_from_object)
            made = [item for item in bpy.data.objects if self._objects.is_sheet(item)]
            if made:
                return made[0]
        self._objects.mark_sheet(sheet)
        return sheet

    def _make_crease(self, item: dict[str, Any], sheet: Any) -> None:
        import bpy

        crease = made_object("Crease", item, sheet)
        if item["by_operator"]:
            select(sheet, crease)
            call(bpy.ops.curvefold.make_crease)
            if self._objects.is_crease(crease):
                return
        if crease.parent is None:
            crease.parent = sheet
        crease.curvefold.role = self._objects.CREASE
        crease.curvefold.assignment = item["assignment"]


# --- what Blender is told ---------------------------------------------------------------------------------------


def call(operator: Any, **options: object) -> None:
    """An operator that may refuse in one line, and must not fail otherwise."""
    if not operator.poll():
        return
    try:
        operator(**options)
    except RuntimeError as error:
        if "Traceback" in str(error) or len(str(error).strip().splitlines()) != 1:
            raise


def select(*items: Any) -> None:
    """Selects these alone; the first one is active."""
    import bpy

    for item in bpy.context.view_layer.objects:
        item.select_set(item in items)
    bpy.context.view_layer.objects.active = items[0]


def made_object(name: str, item: dict[str, Any], sheet: Any = None) -> Any:
    """An object of the scene, with all that is told of it. Its parents hang on the sheet, if there is one."""
    import bpy

    data = _made_data(name, item)
    if item.get("shares") and isinstance(data, bpy.types.Curve) and name in bpy.data.curves:
        data = bpy.data.curves[name]
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    node = sheet
    for place in item["above"]:
        empty = bpy.data.objects.new("Parent", None)
        bpy.context.scene.collection.objects.link(empty)
        empty.parent = node
        _put(empty, place)
        node = empty
    if item["above"]:
        made.parent = node
    if "inverse" in item:
        values = item["inverse"]
        made.matrix_parent_inverse = [values[k : k + 4] for k in range(0, 16, 4)]
    if "place" in item:
        _put(made, item["place"])
    _add_extras(made, item)
    return made


def _made_data(name: str, item: dict[str, Any]) -> Any:
    import bpy

    kind = item.get("type", "CURVE")
    if kind == "EMPTY":
        return None
    if kind == "MESH":
        mesh = bpy.data.meshes.new(name)
        points = [row[:3] for spline in item["splines"] for row in spline["points"]][:200]
        mesh.from_pydata(points, [], [list(range(len(points)))] if len(points) > 2 else [])
        return mesh
    curve = bpy.data.curves.new(name, kind)
    if kind == "CURVE":
        curve.dimensions = item["dimensions"]
        add_splines(curve, item["splines"])
    return curve


def add_splines(curve: Any, splines: list[dict[str, Any]]) -> None:
    for told in splines:
        spline = curve.splines.new(told["type"])
        rows = told["points"]
        points = spline.bezier_points if told["type"] == "BEZIER" else spline.points
        if len(rows) > 1:
            points.add(len(rows) - 1)
        if "resolution" in told:
            spline.resolution_u = told["resolution"]
        for name, key in (("order_u", "order"), ("use_endpoint_u", "endpoint"), ("use_bezier_u", "bezier")):
            if key in told:
                setattr(spline, name, told[key])
        spline.use_cyclic_u = told["cyclic"]
        if not rows:
            continue
        with np.errstate(all="ignore"):
            values = np.array(rows, dtype=np.float64).astype(np.float32)
        if told["type"] == "BEZIER":
            for point in points:
                point.handle_left_type = point.handle_right_type = told.get("handles", "FREE")
            for k, name in enumerate(("handle_left", "co", "handle_right")):
                points.foreach_set(name, np.ascontiguousarray(values[:, 3 * k : 3 * k + 3]).ravel())
        else:
            points.foreach_set("co", np.ascontiguousarray(values[:, :4]).ravel())


def _put(thing: Any, place: dict[str, Any]) -> None:
    thing.location, thing.rotation_euler, thing.scale = place["location"], place["rotation"], place["scale"]


def _add_extras(made: Any, item: dict[str, Any]) -> None:
    if item.get("modifier") and made.type in ("CURVE", "MESH", "FONT", "SURFACE"):
        made.modifiers.new("Modifier", item["modifier"])
    if item.get("shape_key") and made.type in ("CURVE", "MESH", "SURFACE"):
        made.shape_key_add(name="Basis")
        key = made.shape_key_add(name="Other")
        key.value = 0.7
    if item.get("constraint"):
        made.constraints.new("LIMIT_SCALE")
    made.hide_viewport = bool(item.get("hidden"))


def main() -> int:
    with tempfile.TemporaryDirectory(prefix="curvefold-fuzz-") as user:
        checkout.link(ROOT, Path(user))
        checkout.enable(Path(user))
        # What is found is to be read, not all that Blender says on the way.
        sys.stdout = os.fdopen(os.dup(1), "w", buffering=1)
        for stream in (1, 2):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        ours = doors(lambda name: importlib.import_module(f"{checkout.PACKAGE}.{name}"))
        return run(ours, "benchmarks.fuzz_blender", __doc__.splitlines()[0])


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender's own clean-up at exit may crash or hang, and the exit code would not be ours.
    os._exit(status)
