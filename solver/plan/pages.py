"""From a plan and a profile to pages: which lines are drawn in which layer, on which face, and the marks around."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .dashes import segments
from .data import CREASES, Kind, Plan, PlanStroke
from .marks import circle, cross
from .pen import Page, PageLayer
from .pieces import Motion
from .profile import Layer, Profile
from .tiles import tiled
from .walk import Walk

#: A registration mark's cross and ring, mm, and where it stands from the page's edges.
_REACH, _RING, _INSET = 4.0, 2.0, 5.0


def pages_of(plan: Plan, profile: Profile) -> list[Page]:
    """The pages of a plan. Raises DescriptionError where the profile's paper is too small."""
    if profile.pages == "tiles":
        whole = _page(plan, replace(profile, page_margin_mm=0.0, registration=False), "front", "")
        return tiled(whole, profile, plan.name)
    if profile.pages == "front-and-back":
        return [_page(plan, profile, "front", "front"), _mirrored(_page(plan, profile, "back", "back"))]
    return [_page(plan, profile, "front", "")]


def with_dashes(profile: Profile, lengths: Sequence[float]) -> Profile:
    """The same profile with other dashes for every crease; none: whole lines."""
    return replace(
        profile,
        layers=tuple(
            replace(layer, dash_mm=tuple(lengths)) if set(layer.kinds) & set(CREASES) else layer
            for layer in profile.layers
        ),
    )


def _page(plan: Plan, profile: Profile, face: str, name: str) -> Page:
    margin = profile.page_margin_mm
    width, height = plan.width + 2 * margin, plan.height + 2 * margin
    placed = Motion(shift=complex(margin, margin))
    layers = []
    for layer in profile.layers:
        if layer.face not in (face, "both"):
            continue
        lines = [
            (walk.moved(placed), stroke.name)
            for stroke in plan.having(*layer.kinds)
            if stroke.kind is not Kind.GROOVE or stroke.back == (face == "back")
            for walk in segments(stroke, *_dashes(stroke, layer))
        ]
        if profile.registration and Kind.REGISTRATION in layer.kinds:
            lines += [(walk, "registration") for walk in _registration(width, height)]
        if lines:
            layers.append(PageLayer(layer, tuple(lines)))
    return Page(name, width, height, tuple(layers))


def _dashes(stroke: PlanStroke, layer: Layer) -> tuple[Sequence[float], float]:
    """Only creases have margins at their ends."""
    return layer.dash_mm, layer.end_margin_mm if stroke.kind in CREASES else 0.0


def _registration(width: float, height: float) -> list[Walk]:
    """Marks in three corners: with four nobody could tell how a sheet was turned."""
    low, right, top = complex(_INSET, _INSET), width - _INSET, height - _INSET
    found = []
    for at in (low, complex(right, low.imag), complex(low.real, top)):
        found += [*cross(at, _REACH), Walk((circle(at, _RING),), True)]
    return found


def _mirrored(page: Page) -> Page:
    """A page as seen from behind, turned about its upright middle line."""
    motion = Motion(-1.0, complex(page.width, 0.0), True)
    layers = tuple(
        PageLayer(part.layer, tuple((walk.moved(motion), name) for walk, name in part.lines))
        for part in page.layers
    )
    return replace(page, layers=layers)
