"""The drawings of the gallery and what each is told: one place, no tuning but the numbers that are written here.

Lengths are in drawing units; most sheets are one unit wide.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solver import (
    Angle,
    Crease,
    CreasePattern,
    Curve,
    FoldDescription,
    Glue,
    Handle,
    Pair,
    Side,
    Weights,
)
from solver.arrays import FloatArray
from solver.controls.control import Control
from solver.description import LEAST_FOLD


@dataclass(frozen=True, eq=False)
class Figure:
    """One fold. figure: number in the paper; name: of the files; words: what is shown.

    fast: whether it belongs to the fast subset. bars: whether the paper's bounds are meant to hold: not for what
    is shown to fail (no fold condition, all at once). ruled: whether the flat drawing shows the fold's rulings.
    """

    figure: str
    name: str
    words: str
    pattern: CreasePattern
    description: FoldDescription
    fast: bool = False
    bars: bool = True
    ruled: bool = False


def figures() -> tuple[Figure, ...]:
    """All of them, in the paper's order."""
    return (
        *_annuli(),
        *_one_drawing_two_surfaces(),
        *_with_and_without(),
        *_flow_and_at_once(),
        *_propagation(),
        *_alternatives(),
        *_angles(),
        _ring(),
    )


# --- drawings -------------------------------------------------------------------------------------------

_SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])


def _sheet(width: float, height: float) -> FloatArray:
    return _SQUARE * (width, height)


def _arc(ends: Sequence[Sequence[float]], sag: float, letter: str = "U") -> Crease:
    """A parabolic arc between two points, ``sag`` to the left of its chord."""
    a, b = np.asarray(ends, dtype=float)
    t = np.linspace(0.0, 1.0, 61)[:, None]
    left = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a))
    return Crease(points=(1 - t) * a + t * b + 4 * sag * t * (1 - t) * left, assignment=letter)


def _wave(height: float, amplitude: float) -> Crease:
    x = np.linspace(0.0, 1.0, 101)
    return Crease(points=np.column_stack([x, height + amplitude * np.sin(2 * np.pi * x)]))


def _annulus(radii: Sequence[float], hole: float) -> CreasePattern:
    turn = np.linspace(0.0, 2 * np.pi, 192, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    return CreasePattern(
        boundary=circle,
        holes=[hole * circle[::-1]],
        creases=[Crease(points=r * circle, closed=True) for r in radii],
    )


def _drawing(*creases: Crease, sheet: FloatArray = _SQUARE) -> CreasePattern:
    return CreasePattern(boundary=sheet, creases=creases)


_ONE = _drawing(_arc([(0, 0.45), (1, 0.45)], 0.15))
_PARALLEL = _drawing(*(_arc([(0, y), (1, y)], 0.1) for y in (0.15, 0.4, 0.65)))
_TWO = _drawing(*(_arc([(0, y), (1, y)], 0.1) for y in (0.3, 0.6)))
_MIRRORED = _drawing(_arc([(0, 0.3), (1, 0.3)], -0.1), _arc([(0, 0.7), (1, 0.7)], 0.1))
_LENS = _drawing(_arc([(0, 0.5), (1, 0.5)], 0.17), _arc([(0, 0.5), (1, 0.5)], -0.17))
_WAVE = _drawing(_wave(0.5, 0.1))
_CROSSING = _drawing(_arc([(0, 0.3), (1, 0.62)], 0.1), _arc([(0.35, 0), (0.57, 1)], -0.1))
_CORNERS = _drawing(
    _arc([(0.45, 0), (0, 0.45)], -0.08), _arc([(1, 0.45), (0.55, 0)], -0.08),
    _arc([(0.55, 1), (1, 0.55)], -0.08), _arc([(0, 0.55), (0.45, 1)], -0.08),
)  # fmt: skip
_VERTEX = _drawing(
    _arc([(0.5, 0.5), (0, 0.32)], 0.04), _arc([(0.5, 0.5), (0.68, 0)], 0.04),
    _arc([(0.5, 0.5), (1, 0.68)], 0.04), _arc([(0.5, 0.5), (0.32, 1)], 0.04),
)  # fmt: skip


def _told(
    *controls: Control,
    resolution: int = 32,
    angle: float | None = None,
    handles: tuple[Handle, ...] = (),
    weights: Weights | None = None,
    least_fold: float = LEAST_FOLD,
) -> FoldDescription:
    return FoldDescription(
        resolution, angle, handles, weights=weights or Weights(), controls=controls, least_fold=least_fold
    )


def _pinch(inward: float, lift: float) -> tuple[Handle, ...]:
    """The corners of the unit square moved inwards along x and up."""
    return tuple(
        Handle(at=(x, y), target=(x + (inward if x < 0.5 else -inward), y, lift)) for x, y in _SQUARE.tolist()
    )


# --- figures --------------------------------------------------------------------------------------------


def _annuli() -> tuple[Figure, ...]:
    words = "an annulus with {} concentric creases; one pair of opposite points is drawn together"
    pair = Pair((-1.0, 0.0), (1.0, 0.0), distance=1.25)
    return (
        Figure("1", "annulus_two", words.format("two"), _annulus((0.6, 0.8), 0.4), _told(pair, resolution=80)),
        Figure(
            "1", "annulus_four", words.format("four"), _annulus((0.52, 0.64, 0.76, 0.88), 0.4),
            _told(Pair((-1.0, 0.0), (1.0, 0.0), distance=1.65), resolution=56),
        ),
    )  # fmt: skip


def _one_drawing_two_surfaces() -> tuple[Figure, ...]:
    words = (
        "one arc folded into two surfaces, here {}, and the fold's rulings on the flat sheet "
        "(brown: cones, blue: cylinders, green: neither)"
    )
    return tuple(
        Figure(
            "2", f"surface_{name}", words.format(how), _ONE,
            _told(Curve(1, curvature_times=times, torsion_plus=torsion)), fast=name == "twisted", ruled=True,
        )
        for name, how, times, torsion in (
            ("twisted", "with 1.3 times its curvature and a torsion of 1.2", 1.3, 1.2),
            ("plane", "with 1.7 times its curvature in a plane", 1.7, 0.0),
        )
    )  # fmt: skip


def _with_and_without() -> tuple[Figure, ...]:
    drawings = {"arc": _ONE, "pleats": _PARALLEL, "lens": _LENS, "wave": _WAVE, "corners": _CORNERS}
    # How far each can be pushed together before the paper stretches: three pleats in a row less than one wave.
    inwards = {"arc": 0.12, "pleats": 0.05, "lens": 0.07, "wave": 0.25, "corners": 0.07}
    result = []
    for name, drawing in drawings.items():
        for condition in (True, False):
            words = f"{name}: corners moved in and up, {'with' if condition else 'without'} the fold condition"
            result.append(
                Figure(
                    "3", f"{name}_{'with' if condition else 'without'}", words, drawing,
                    _told(
                        handles=_pinch(inwards[name], 0.12),
                        weights=Weights(fold_condition=float(condition)), least_fold=0.0,
                    ),
                    fast=name == "arc", bars=condition,
                )
            )  # fmt: skip
    return tuple(result)


#: So fast that a flow is over in its first step.
_AT_ONCE = 1e6


def _flow_and_at_once() -> tuple[Figure, ...]:
    return tuple(
        Figure(
            "6", name, words, _ONE, _told(Curve(1, curvature_times=1.4, torsion_plus=1.8, speed=speed)),
            fast=name == "flow", bars=name == "flow",
        )
        for name, words, speed in (
            ("flow", "an arc led to 1.4 times its curvature and a torsion of 1.8, step by step", 1.0),
            ("at_once", "the same arc asked for the same at once, which the paper's solver could not do", _AT_ONCE),
        )
    )  # fmt: skip


def _propagation() -> tuple[Figure, ...]:
    drawings = {"pleats": _PARALLEL, "mirrored": _MIRRORED, "vertex": _VERTEX}
    return tuple(
        Figure(
            "8", f"{name}_{'valley' if side == 'V' else 'mountain'}",
            f"{name}: crease 1 is to be a {'valley' if side == 'V' else 'mountain'}, the others find theirs",
            drawing, _told(Side(1, side), angle=50.0), fast=name == "mirrored" and side == "V",
        )
        for name, drawing in drawings.items()
        for side in ("V", "M")
    )  # fmt: skip


def _alternatives() -> tuple[Figure, ...]:
    result = []
    for name, drawing in (("parallel", _TWO), ("mirrored", _MIRRORED)):
        for letter, word in (("V", "valley"), ("M", "mountain")):
            degrees = 50.0 if letter == "V" else -50.0
            result.append(
                Figure(
                    "13", f"{name}_flow_{word}",
                    f"{name}: crease 1 flows to 1.2 times its curvature, crease 2 is a {word} of 50°",
                    drawing,
                    _told(Curve(1, curvature_times=1.2), Side(1, "V"), Angle(degrees, crease=2, signed=True)),
                )
            )  # fmt: skip
    return tuple(result)


def _angles() -> tuple[Figure, ...]:
    held = (Handle(at=(0.5, 0.5), target=(0.5, 0.5, 0.0)),)
    return (
        Figure(
            "14", "lens_angles", "a lens gadget: 90° at the middle of both arcs", _LENS,
            _told(Angle(90.0, at=(0.5, 0.67)), Angle(90.0, at=(0.5, 0.33)), handles=held), fast=True,
        ),
        Figure(
            "14", "wave_angles", "a wave: 80° at its crest and at its trough", _WAVE,
            _told(Angle(80.0, at=(0.25, 0.6)), Angle(80.0, at=(0.75, 0.4)), handles=held),
        ),
        Figure(
            "14", "corner_angles", "four corner arcs: 30°, 60°, 90° and 120° at their middles", _CORNERS,
            _told(
                Angle(30.0, at=(0.3, 0.3)), Angle(60.0, at=(0.7, 0.3)), Angle(90.0, at=(0.7, 0.7)),
                Angle(120.0, at=(0.3, 0.7)), handles=held,
            ),
        ),
    )  # fmt: skip


def _ring() -> Figure:
    length, width, count = 4.0, 0.5, 20
    places = (np.arange(count) + 0.5) * length / count
    creases = [_arc([(x, 0), (x, width)], 0.05 * (-1) ** k) for k, x in enumerate(places.tolist())]
    seam = Glue(((0.0, 0.0), (0.0, width)), ((length, 0.0), (length, width)))
    return Figure(
        "15", "ring", "a strip with twenty creases, glued to a ring from flat",
        CreasePattern(boundary=_sheet(length, width), creases=creases), _told(seam, resolution=120),
    )  # fmt: skip
