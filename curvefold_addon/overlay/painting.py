"""How overlays are drawn: in space behind Blender's depth buffer, texts and marks in pixels on top."""

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import blf
import bpy
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector

from ..bridge import drawing_objects
from ..bridge import overlay as arrays
from ..bridge.drawn import Outline
from . import content, drawing_lines, trouble_marks

#: Pixels at a resolution scale of 1.
CREASE_WIDTH, RULING_WIDTH, PULL_WIDTH = 1.8, 1.2, 2.0
#: Of a drawing's lines; thin, also where they are selected.
LINE_WIDTH = 1.8
BALL_WIDTH, IMAGE_WIDTH, PATCH_RADIUS = 1.0, 1.6, 5.0
MARK_RADIUS, TROUBLE_RADIUS, TEXT_SIZE, TEXT_PADDING = 4.0, 8.0, 12.0, 4.0
#: Lines on the paper are drawn this part of the distance nearer to the eye, so that they do not sink into it.
LIFT = 0.003
#: What lies behind the paper shines through this much.
BEHIND = (0.75, 0.75, 0.75, 0.30)
PLATE = (0.08, 0.08, 0.08, 0.78)
TROUBLE = (1.0, 0.33, 0.10, 1.0)
WHITE = (1.0, 1.0, 1.0, 1.0)

_log = logging.getLogger(__name__)
_handles: list[object] = []
_reported: set[str] = set()


@dataclass(frozen=True)
class _Batch:
    source: object
    batch: object


#: Of the shapes drawn last, by mesh and overlay.
_batches: dict[tuple[int, str], _Batch] = {}


def register() -> None:
    for function, when in ((_draw_in_space, "POST_VIEW"), (_draw_on_screen, "POST_PIXEL")):
        _handles.append(bpy.types.SpaceView3D.draw_handler_add(_safely(function), (), "WINDOW", when))


def unregister() -> None:
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    _batches.clear()
    _reported.clear()


def _safely(draw: Callable[[bpy.types.Context], None]) -> Callable[[], None]:
    """A draw handler that reports an error once instead of at every redraw."""

    def handler() -> None:
        try:
            draw(bpy.context)
        except Exception as error:
            if repr(error) not in _reported:
                _reported.add(repr(error))
                _log.exception("an overlay could not be drawn")

    return handler


def _wanted(context: bpy.types.Context) -> bpy.types.PropertyGroup | None:
    """The overlay settings when this viewport shows overlays."""
    settings = context.scene.curvefold
    shown = settings.show and context.space_data.overlay.show_overlays
    return settings if shown and context.region_data is not None else None


# --- in space ----------------------------------------------------------------------------------------------


def _draw_in_space(context: bpy.types.Context) -> None:
    settings = _wanted(context)
    if settings is None:
        return
    for paper in content.papers(context):
        drawn = content.of_paper(paper, settings)
        if drawn is not None:
            _draw_paper(context, drawn)
    if settings.creases:
        _draw_drawings(context)


def _draw_drawings(context: bpy.types.Context) -> None:
    """Blender shows a line without thickness in one colour, and lines in one plane with a paper in pieces."""
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)
    gpu.state.depth_test_set("LESS_EQUAL")
    try:
        for drawn in drawing_lines.shown(context):
            uid = drawn.part.session_uid
            with gpu.matrix.push_pop():
                gpu.matrix.load_matrix(_lifted(context.region_data) @ drawn.part.matrix_world)
                _draw_lines(context, (uid, "drawing"), drawn.lines, LINE_WIDTH, drawn.color)
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(True)
        gpu.state.blend_set("NONE")


def _draw_paper(context: bpy.types.Context, drawn: content.PaperContent) -> None:
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)
    try:
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(_lifted(context.region_data) @ drawn.paper.matrix_world)
            uid = drawn.paper.data.session_uid
            if drawn.stretch is not None:
                gpu.state.depth_test_set("LESS_EQUAL")
                _draw_surface((uid, "stretch"), drawn.stretch)
            for name, lines, width in (
                ("rulings", drawn.rulings, RULING_WIDTH),
                ("creases", drawn.creases, CREASE_WIDTH),
            ):
                if lines is not None:
                    gpu.state.depth_test_set("LESS_EQUAL")
                    _draw_lines(context, (uid, name), lines, width)
            if drawn.creases is not None:
                gpu.state.depth_test_set("GREATER")
                _draw_lines(context, (uid, "behind"), drawn.creases, CREASE_WIDTH, BEHIND)
            if drawn.gauss_image is not None:
                gpu.state.depth_test_set("LESS_EQUAL")
                with gpu.matrix.push_pop():
                    gpu.matrix.multiply_matrix(_ball_matrix(context.region_data, drawn))
                    _draw_lines(context, (uid, "ball"), drawn.gauss_image.circles, BALL_WIDTH)
                    _draw_lines(context, (uid, "image"), drawn.gauss_image.image, IMAGE_WIDTH)
            gpu.state.depth_test_set("NONE")
            for k, pulls in enumerate(drawn.pulls):
                _draw_lines(context, (uid, f"pulls {k}"), pulls.lines, PULL_WIDTH)
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(True)
        gpu.state.blend_set("NONE")


def _lifted(view: bpy.types.RegionView3D) -> Matrix:
    """The view matrix with everything nearer; in perspective scaled about the eye, which moves no pixel."""
    if view.is_perspective:
        return Matrix.Diagonal((1 - LIFT, 1 - LIFT, 1 - LIFT, 1.0)) @ view.view_matrix
    return Matrix.Translation((0.0, 0.0, LIFT * view.view_distance)) @ view.view_matrix


def _ball_matrix(view: bpy.types.RegionView3D, drawn: content.PaperContent) -> Matrix:
    """From the unit ball to the paper's coordinates: left of the paper, from wherever it is looked at."""
    # The sidebar is at the right.
    left = drawn.paper.matrix_world.to_3x3().inverted_safe() @ (view.view_rotation @ Vector((-1.0, 0.0, 0.0)))
    place = drawn.gauss_image.beside(tuple(left))
    return Matrix.LocRotScale(place.centre, None, (place.radius,) * 3)


def _draw_lines(
    context: bpy.types.Context,
    key: tuple[int, str],
    lines: arrays.Lines | Outline,
    width: float,
    color: tuple[float, float, float, float] | None = None,
) -> None:
    """In one ``color``, or in those that the lines have."""
    if len(lines.points) == 0:
        return
    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR" if color is None else "POLYLINE_UNIFORM_COLOR")
    values = {"pos": lines.points} if color is not None else {"pos": lines.points, "color": lines.colors}
    batch = _batch(key, lines, lambda: batch_for_shader(shader, "LINES", values))
    shader.bind()
    shader.uniform_float("viewportSize", (context.region.width, context.region.height))
    shader.uniform_float("lineWidth", width * context.preferences.system.ui_scale)
    if color is not None:
        shader.uniform_float("color", color)
    batch.draw(shader)


def _draw_surface(key: tuple[int, str], surface: arrays.Surface) -> None:
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    values = {"pos": surface.points, "color": surface.colors}
    batch = _batch(key, surface, lambda: batch_for_shader(shader, "TRIS", values, indices=surface.triangles))
    shader.bind()
    batch.draw(shader)


def _batch(key: tuple[int, str], source: object, make: Callable[[], object]) -> object:
    """The batch of ``source``, made when it is another than last time."""
    kept = _batches.get(key)
    if kept is None or kept.source is not source:
        for gone in [other for other in _batches if not _is_kept(other[0])]:
            del _batches[gone]
        kept = _batches[key] = _Batch(source, make())
    return kept.batch


def _is_kept(uid: int) -> bool:
    return content.is_kept(uid) or drawing_lines.is_kept(uid)


# --- on the screen -------------------------------------------------------------------------------------------


def _draw_on_screen(context: bpy.types.Context) -> None:
    settings = _wanted(context)
    if settings is None:
        return
    gpu.state.blend_set("ALPHA")
    try:
        for paper in content.papers(context):
            drawn = content.of_paper(paper, settings)
            if drawn is not None:
                _draw_marks(context, drawn)
        if settings.troubles:
            _draw_troubles(context)
    finally:
        gpu.state.blend_set("NONE")


def _draw_marks(context: bpy.types.Context, drawn: content.PaperContent) -> None:
    matrix = drawn.paper.matrix_world
    for color, points in () if drawn.gauss_image is None else drawn.gauss_image.marks:
        places = [_on_screen(context, matrix @ Vector(point)) for point in points]
        _draw_diamonds(context, places, PATCH_RADIUS, color)
    for pulls in drawn.pulls:
        places = [_on_screen(context, matrix @ Vector(point)) for point in pulls.points]
        _draw_diamonds(context, places, MARK_RADIUS, pulls.color)
    for label in drawn.angles:
        place = _on_screen(context, matrix @ Vector(label.place))
        if place is not None:
            _draw_text(context, label.text, place, label.color)


def _draw_troubles(context: bpy.types.Context) -> None:
    for sheet in context.view_layer.objects:
        is_sheet = sheet.type == "CURVE" and drawing_objects.is_sheet(sheet)
        if not is_sheet or not sheet.visible_in_viewport_get(context.space_data):
            continue
        for trouble in trouble_marks.of_sheet(sheet):
            place = None if trouble.place is None else _on_screen(context, Vector(trouble.place))
            if place is None:
                continue
            _draw_diamonds(context, [place], TROUBLE_RADIUS, TROUBLE)
            beside = place + Vector((1.8 * TROUBLE_RADIUS * context.preferences.system.ui_scale, 0.0))
            _draw_text(context, trouble.sentence, beside, PLATE, centred=False)


def _on_screen(context: bpy.types.Context, place: Vector) -> Vector | None:
    """Pixels of a point in the world, None when it is not in front of the eye."""
    return location_3d_to_region_2d(context.region, context.region_data, place)


def _draw_diamonds(
    context: bpy.types.Context,
    places: Iterable[Vector | None],
    radius: float,
    color: tuple[float, float, float, float],
) -> None:
    scale = context.preferences.system.ui_scale
    seen = [place for place in places if place is not None]
    for size, fill in ((radius + 1.5, PLATE), (radius, color)):
        reach = size * scale
        corners = [
            (x + dx * reach, y + dy * reach)
            for x, y in seen
            for dx, dy in ((1, 0), (0, 1), (-1, 0), (1, 0), (-1, 0), (0, -1))
        ]
        _draw_triangles(corners, fill)


def _draw_text(
    context: bpy.types.Context,
    text: str,
    place: Vector,
    plate: tuple[float, float, float, float],
    centred: bool = True,
) -> None:
    """A line of text on a plate, its middle at ``place`` or its left end."""
    font = 0
    scale = context.preferences.system.ui_scale
    blf.size(font, TEXT_SIZE * scale)
    width, _ = blf.dimensions(font, text)
    # The same height for all texts, whatever their letters.
    _, height = blf.dimensions(font, "0")
    pad = TEXT_PADDING * scale
    x0 = place.x - (0.5 * width if centred else -pad)
    y0 = place.y - 0.5 * height
    left, right, low, high = x0 - pad, x0 + width + pad, y0 - pad, y0 + height + pad
    corners = [(left, low), (right, low), (right, high), (left, low), (right, high), (left, high)]
    _draw_triangles(corners, plate)
    blf.color(font, *WHITE)
    blf.position(font, x0, y0, 0.0)
    blf.draw(font, text)


def _draw_triangles(corners: Sequence[tuple[float, float]], color: tuple[float, float, float, float]) -> None:
    if not corners:
        return
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": [(x, y, 0.0) for x, y in corners]})
    gpu.state.blend_set("ALPHA")
    shader.bind()
    shader.uniform_float("color", color)
    batch.draw(shader)
