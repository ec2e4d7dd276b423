"""FOLD files as origami programs write them: planar graphs of vertices and edges. No file is copied."""

from __future__ import annotations

import itertools
import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from tests.solver.pattern.strangers_designs import FloatArray, Rng
from tests.solver.pattern.strangers_habits import Page, Stroke
from tests.solver.pattern.strangers_pen import Export, Look

#: Points nearer than this are one vertex, mm.
_SAME = 1e-4
_LETTERS = {"border": "B", "hole": "B", "cut": "C", "M": "M", "V": "V", "U": "U", "facet": "F"}
_ANGLES = {"M": -180.0, "V": 180.0, "F": 0.0}


class _Graph:
    """Vertices (mm) and edges of all strokes, cut where they meet."""

    def __init__(self, strokes: Sequence[Stroke]) -> None:
        known = [stroke for stroke in strokes if stroke.kind in _LETTERS]
        drawn = [shapely.LineString(np.round(stroke.curve.points(9), 5)) for stroke in known]
        # What ends on a line may miss it by rounding: the lines are brought together before they are cut.
        noded = shapely.get_parts(shapely.union_all(drawn, grid_size=_SAME))
        tree = shapely.STRtree(drawn)
        ids: dict[tuple[float, float], int] = {}
        self.points: list[tuple[float, float]] = []
        self.edges: list[tuple[int, int]] = []
        self.letters: list[str] = []
        for line in noded:
            at = [self._vertex(ids, point) for point in shapely.get_coordinates(line)]
            for a, b in itertools.pairwise(at):
                if a == b:
                    continue
                middle = shapely.Point(np.mean([self.points[a], self.points[b]], axis=0))
                near = tree.query_nearest(middle)
                self.edges.append((a, b))
                self.letters.append(min((_LETTERS[known[k].kind] for k in near), key="BCMVUF".index))

    def _vertex(self, ids: dict[tuple[float, float], int], point: FloatArray) -> int:
        key = (round(float(point[0]), 4), round(float(point[1]), 4))
        if key not in ids:
            ids[key] = len(self.points)
            self.points.append(key)
        return ids[key]

    def faces(self) -> list[list[int]]:
        ids = {point: k for k, point in enumerate(self.points)}
        lines = [shapely.LineString([self.points[a], self.points[b]]) for a, b in self.edges]
        made = []
        for polygon in shapely.get_parts(shapely.polygonize(lines)):
            ring = shapely.get_coordinates(shapely.orient_polygons(polygon).exterior)[:-1]
            made.append([ids[(float(x), float(y))] for x, y in ring])
        return made

    def angles(self) -> list[float | None]:
        return [_ANGLES.get(letter) for letter in self.letters]


def _text(data: dict[str, Any]) -> str:
    return json.dumps(data, indent=1 if len(data) % 2 else None) + "\n"


def rabbit_ear_fold(page: Page, look: Look, rng: Rng) -> Export:
    """A square of one unit, with faces and angles."""
    graph = _Graph(page.strokes)
    scale = 1.0 / max(page.width, page.height)
    data = {
        "file_spec": 1.2,
        "file_creator": "Rabbit Ear",
        "file_classes": ["singleModel"],
        "frame_classes": ["creasePattern"],
        "vertices_coords": [[x * scale, y * scale] for x, y in graph.points],
        "edges_vertices": graph.edges,
        "edges_assignment": graph.letters,
        "edges_foldAngle": graph.angles(),
        "faces_vertices": graph.faces(),
    }
    return Export(_text(data), scale, 100.0, ".fold")


def simulator_fold(page: Page, look: Look, rng: Rng) -> Export:
    """Origami Simulator: on the floor (x, 0, z), called a folded form in half of the files, angles null."""
    graph = _Graph(page.strokes)
    scale = 0.3
    data = {
        "file_spec": 1.1,
        "file_creator": "Origami Simulator: http://git.amandaghassaei.com/OrigamiSimulator/",
        "file_author": "",
        "frame_title": "sheet",
        "frame_classes": ["foldedForm" if rng.random() < 0.5 else "creasePattern"],
        "frame_attributes": ["3D"],
        "frame_unit": "unit",
        "vertices_coords": [[x * scale, 0.0, -y * scale] for x, y in graph.points],
        "edges_vertices": graph.edges,
        "edges_assignment": graph.letters,
        "edges_foldAngle": [None for _ in graph.edges],
        "faces_vertices": graph.faces(),
    }
    return Export(_text(data), scale, None, ".fold")


def oriedita_fold(page: Page, look: Look, rng: Rng) -> Export:
    """Centred on a square of 400, edges only, keys of its own."""
    graph = _Graph(page.strokes)
    scale = 400.0 / max(page.width, page.height)
    data = {
        "file_spec": 1.1,
        "file_creator": "oriedita",
        "file_frames": [],
        "frame_attributes": [],
        "vertices_coords": [[x * scale - 200.0, y * scale - 200.0] for x, y in graph.points],
        "edges_vertices": graph.edges,
        "edges_assignment": graph.letters,
        "oriedita:circles_coords": [],
        "oriedita:version": "1.1.3",
    }
    return Export(_text(data), scale, None, ".fold")


def frames_fold(page: Page, look: Look, rng: Rng) -> Export:
    """The crease pattern as one frame of several, the folded form first; in inches."""
    graph = _Graph(page.strokes)
    flat = [[x / 25.4, y / 25.4] for x, y in graph.points]
    bent = [[x, 0.8 * y, 0.3 * abs(y)] for x, y in flat]
    data = {
        "file_spec": 1.2,
        "file_creator": "a script",
        "file_classes": ["multiModel"],
        "frame_unit": "in",
        "edges_vertices": graph.edges,
        "edges_assignment": graph.letters,
        "file_frames": [
            {"frame_classes": ["foldedForm"], "frame_inherit": True, "frame_parent": 0, "vertices_coords": bent},
            {"frame_classes": ["creasePattern"], "frame_inherit": True, "frame_parent": 0, "vertices_coords": flat},
        ],
    }
    return Export(_text(data), 1 / 25.4, 25.4, ".fold")
