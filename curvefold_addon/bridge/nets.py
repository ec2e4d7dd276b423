"""Nets of papers: made from what a .blend keeps, as fine as it is told, or as the drawing needs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from ...solver import CurvefoldError, PiecewiseDog, build_net, choose_resolution
from ...solver.net.carry_over import scaled
from . import state
from .controls import DrawnCrease

#: Vertices that an automatic resolution may use: so large a paper still follows the hand while it is drawn.
LIVE_VERTICES = 3000
#: What an automatic resolution is rounded to, quads along the longer side: four numbers to a doubling, so that it
#: seldom changes while the drawing is edited, and nothing but the drawing decides it.
STEPS = tuple(first * 2**doubled for doubled in range(8) for first in (4, 5, 6, 7))
#: Nets that are kept although no paper shows them: undo and redo step back and forth between them.
_KEPT = 8


@dataclass(frozen=True)
class Choice:
    """source: with a resolution of its own; notes: why it has this one, where it was left to be chosen."""

    source: state.Source
    notes: tuple[str, ...]


def forget() -> None:
    """What is kept can be made again."""
    net_of.cache_clear()
    drawn_of.cache_clear()
    state.pattern_of.cache_clear()


@lru_cache(maxsize=_KEPT)
def net_of(source: state.Source) -> PiecewiseDog:
    """The net of a source, in the paper's units. Raises CurvefoldError."""
    net = build_net(state.pattern_of(source), source.resolution)
    return net if source.scale == 1.0 else scaled(net, source.scale)


@lru_cache(maxsize=_KEPT)
def drawn_of(source: state.Source) -> tuple[DrawnCrease, ...]:
    """The creases as they are drawn."""
    pattern = state.pattern_of(source)
    creases = []
    for k, crease in enumerate(pattern.creases):
        first, last = ((float(x) * source.scale, float(y) * source.scale) for x, y in crease.points[[0, -1]])
        creases.append(DrawnCrease(pattern.crease_label(k), crease.assignment, (first, last)))
    return tuple(creases)


def choose(wanted: state.Source) -> Choice:
    """What a source comes to whose resolution may be left to be chosen. In any thread. Raises CurvefoldError."""
    if wanted.resolution != state.AUTOMATIC:
        return Choice(wanted, ())
    chosen = choose_resolution(state.pattern_of(wanted), LIVE_VERTICES)
    quads = next((step for step in _near(chosen.quads) if _holds(_with(wanted, step))), chosen.quads)
    rounded = "" if quads == chosen.quads else f"; here {quads}, a number that seldom changes while one draws"
    return Choice(_with(wanted, quads), (chosen.sentence + rounded,))


def _near(quads: int) -> list[int]:
    """The steps around a resolution, the finer one first."""
    finer = [step for step in STEPS if step >= quads][:1]
    coarser = [step for step in STEPS if step <= quads][-1:]
    return [*finer, *coarser]


def _with(wanted: state.Source, quads: int) -> state.Source:
    return replace(wanted, resolution=quads, automatic=True)


def _holds(source: state.Source) -> bool:
    """Whether a net is within the limit; it is kept, and wanted next."""
    try:
        return len(net_of(source).rest) <= LIVE_VERTICES
    except CurvefoldError:
        return False
