"""The lines of a drawing as they are drawn in the viewport, where Blender shows no colours of lines itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import drawing_objects
from .drawing import shown_strands
from .drawn import Color, Outline, single
from .overlay import MOUNTAIN, VALLEY

#: Segments of a curved piece: those of Blender's own curves.
PIECES = 24
BORDER: Color = (0.05, 0.05, 0.05, 1.0)
#: Display colours (sRGB) of creases, for FOLD's letters: those of folded papers where they have some.
COLORS: dict[str, Color] = {
    "M": MOUNTAIN,
    "V": VALLEY,
    "U": (0.62, 0.32, 0.92, 1.0),
    "F": (0.45, 0.45, 0.45, 1.0),
}


def color_of(part: Any) -> Color:
    """How the lines of a sheet's border, or of a crease, are coloured."""
    return BORDER if drawing_objects.is_sheet(part) else COLORS[part.curvefold.assignment]


def lines_of(part: Any) -> Outline | None:
    """The lines of a part of a drawing in its own coordinates; None when it has none."""
    runs = []
    for strand in shown_strands(part) if part.type == "CURVE" else []:
        if len(strand.cubics) == 0:
            continue
        times = np.array([0.0, 1.0]) if strand.polyline else np.linspace(0.0, 1.0, PIECES + 1)
        basis = np.stack([(1 - times) ** 3, 3 * times * (1 - times) ** 2, 3 * times**2 * (1 - times), times**3])
        places = np.einsum("kt,skc->stc", basis, strand.cubics)
        runs.append(np.stack([places[:, :-1], places[:, 1:]], axis=2).reshape(-1, 3))
    return Outline(single(np.concatenate(runs))) if runs else None
