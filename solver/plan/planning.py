"""Plans from end to end: what is asked in, pages out, and files."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import DescriptionError
from ..fold import FoldResult
from ..pattern.crease_pattern import CreasePattern
from .board import with_grooves
from .data import Kind, Plan
from .pages import pages_of, with_dashes
from .pen import Page
from .profile import PAPERS, Profile, dash_lengths, read_profile
from .sheet import make_plan, placing
from .source import PlanSource, of_pattern, of_result, read_plan_source
from .tabs import with_tabs
from .writing import plan_files, write_files

#: Board is at most so thick, mm.
_MOST_THICKNESS = 50.0
#: Tabs are at most so wide, mm.
_MOST_TABS = 100.0


@dataclass(frozen=True)
class PlanDescription:
    """What a plan is told.

    profile       the name of one of the house, a file, or a profile
    thickness_mm  of board, for grooves; None: none
    dash_mm       of all creases instead of the profile's; () for whole lines, None as the profile has it
    tile          paper on which the plan is printed in pieces; None as the profile has it
    tabs_mm       width of tabs along glued borders; None: none
    rulings       whether rulings are drawn where they are known
    Raises DescriptionError.
    """

    profile: str | Path | Profile = "origami"
    thickness_mm: float | None = None
    dash_mm: tuple[float, ...] | None = None
    tile: str | None = None
    tabs_mm: float | None = None
    rulings: bool = False

    def __post_init__(self) -> None:
        if self.thickness_mm is not None and not 0.0 < self.thickness_mm <= _MOST_THICKNESS:
            raise DescriptionError(
                f"it must be more than 0 and at most {_MOST_THICKNESS:g} mm", element="thickness"
            )
        if self.tabs_mm is not None and not 0.0 < self.tabs_mm <= _MOST_TABS:
            raise DescriptionError(f"they must be more than 0 and at most {_MOST_TABS:g} mm wide", element="tabs")
        if self.dash_mm is not None:
            object.__setattr__(self, "dash_mm", dash_lengths(self.dash_mm, "dash"))
        if self.tile is not None and self.tile not in PAPERS:
            raise DescriptionError(
                f"unknown paper {self.tile!r}, expected one of {', '.join(PAPERS)}", element="tile"
            )

    def read(self) -> Profile:
        """Its profile. Raises DescriptionError."""
        return self.profile if isinstance(self.profile, Profile) else read_profile(self.profile)


@dataclass(frozen=True)
class PlanResult:
    """A plan and its pages, as they are drawn."""

    plan: Plan
    pages: tuple[Page, ...]


def plan(
    source: CreasePattern | FoldResult | PlanSource | str | os.PathLike[str],
    description: PlanDescription | None = None,
) -> PlanResult:
    """The plan of a drawing, of a fold, or of what a path leads to: a drawing, a folded file, a folder of results.

    Raises CurvefoldError where they cannot be a plan as it is described.
    """
    told = description or PlanDescription()
    check_grooves(told)
    profile = told.read()
    if told.dash_mm is not None:
        profile = with_dashes(profile, told.dash_mm)
    if told.tile is not None:
        if profile.pages == "front-and-back":
            raise DescriptionError(
                f"profile {profile.name!r} makes a front and a back, which are not printed in tiles"
            )
        profile = replace(profile, pages="tiles", tile=told.tile, registration=True)
    known = _source(source, told.rulings)
    made = make_plan(known, profile.tolerance_mm)
    if told.thickness_mm is not None:
        made = with_grooves(
            made, told.thickness_mm, profile.groove_passes, profile.least_bend_radius, profile.tolerance_mm
        )
    if told.tabs_mm is not None:
        made = with_tabs(made, known.joints, placing(known), told.tabs_mm)
    if told.rulings and not made.having(Kind.RULING):
        raise DescriptionError("no rulings are known of it; fold it with --rulings, and give the folder of results")
    return PlanResult(made, tuple(pages_of(made, profile)))


def check_grooves(told: PlanDescription) -> None:
    """Raises DescriptionError where there is a thickness without grooves, or grooves without a thickness."""
    profile, thickness = told.read(), told.thickness_mm
    if thickness is None and profile.grooves:
        raise DescriptionError(f"profile {profile.name!r} draws grooves, which need the board's thickness")
    if thickness is not None and not profile.grooves:
        raise DescriptionError(
            f"profile {profile.name!r} draws no grooves; leave the thickness out, or choose a profile with a layer "
            "of the kind groove, such as board"
        )


def write_plan(
    result: PlanResult, path: str | os.PathLike[str], sources: Iterable[str | os.PathLike[str]] = ()
) -> tuple[Path, ...]:
    """Write a plan; the suffix says how. Several pages are one PDF, or a file each with the page's name.

    sources: what the plan is made from, which is never written over. Returns the files. Raises CurvefoldError.
    """
    files = plan_files(result.pages, path, result.plan.name or "plan")
    write_files(files, sources)
    return tuple(files)


def _source(
    source: CreasePattern | FoldResult | PlanSource | str | os.PathLike[str], with_rulings: bool
) -> PlanSource:
    if isinstance(source, PlanSource):
        return source if with_rulings else replace(source, rulings=None)
    if isinstance(source, FoldResult):
        return of_result(source, with_rulings)
    if isinstance(source, CreasePattern):
        return of_pattern(source)
    return _source(read_plan_source(source), with_rulings)
