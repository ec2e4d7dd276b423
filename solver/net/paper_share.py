"""How much of each quad is paper: cells that a crease or the border cuts have a whole quad all the same."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..arrays import FloatArray
from .piecewise_dog import PiecewiseDog


@lru_cache(maxsize=4)
def paper_areas(net: PiecewiseDog) -> FloatArray:
    """(Q,) area of the paper in each quad, net units."""
    over, topology = net.overlay, net.topology
    solid = topology.face_quad >= 0
    area: FloatArray = np.zeros(len(net.quads))
    np.add.at(area, topology.face_quad[solid], over.area[solid])
    # The overlay's areas are those of before lengths became net units.
    area *= net.sheet.area / over.area.sum()
    area.setflags(write=False)
    return area


@lru_cache(maxsize=4)
def paper_shares(net: PiecewiseDog) -> FloatArray:
    """(Q,) part of each quad that is paper, 0 to 1."""
    corners = net.flat[net.quads]
    whole = (corners[:, 1, 0] - corners[:, 0, 0]) * (corners[:, 3, 1] - corners[:, 0, 1])
    share = np.clip(paper_areas(net) / whole, 0.0, 1.0)
    share.setflags(write=False)
    return share
