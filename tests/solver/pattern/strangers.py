"""Drawings as the world writes them, of patterns of our own, each with what its author meant.

``stranger(number)`` is always the same file for the same number; exporters and designs come in turn, habits by
chance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from solver import CreasePattern
from tests.solver.pattern import strangers_editors as editors
from tests.solver.pattern import strangers_fold_files as fold_files
from tests.solver.pattern import strangers_programs as programs
from tests.solver.pattern.strangers_designs import DESIGNS, Design, Rng
from tests.solver.pattern.strangers_habits import FORMS, MARKS, Habits, MeantSheet, Page, habits_of, lay_out
from tests.solver.pattern.strangers_judge import faults
from tests.solver.pattern.strangers_pen import Export, Look, look

_LOOKS = ("colours", "dashes", "plain", "one colour")
_POLYLINES = ("polyline", "pieces")


@dataclass(frozen=True)
class Exporter:
    """A program. marks and forms: what it, or the people who use it, write; blank: whether it loses all creases."""

    write: Callable[[Page, Look, Rng], Export]
    marks: tuple[str, ...] = MARKS
    forms: tuple[str, ...] = FORMS
    closed: bool = False  # whether its border is always drawn and closed
    bordered: bool = False  # whether its border is always drawn
    blank: bool = False

    @property
    def name(self) -> str:
        return self.write.__name__


EXPORTERS: tuple[Exporter, ...] = (
    Exporter(editors.inkscape_old, forms=("as it is", "pieces")),
    Exporter(editors.inkscape_new),
    Exporter(editors.illustrator, forms=("as it is", "as it is", "pieces", "dashes")),
    Exporter(editors.illustrator_export, forms=("as it is", "polyline")),
    Exporter(editors.illustrator_old, forms=("as it is",)),
    Exporter(editors.figma, forms=("as it is", "polyline")),
    Exporter(editors.affinity, forms=("as it is",)),
    Exporter(editors.corel, forms=("as it is", "pieces")),
    Exporter(editors.gravit, forms=("as it is",)),
    Exporter(editors.boxy, forms=("as it is",)),
    Exporter(editors.libreoffice, _LOOKS, ("as it is", "polyline")),
    Exporter(editors.word, _LOOKS, ("as it is", "polyline")),
    Exporter(editors.cricut, ("one colour", "colours"), ("as it is", "polyline"), closed=True),
    Exporter(editors.silhouette, ("colours", "one colour", "plain"), ("as it is", "pieces")),
    Exporter(programs.librecad, ("names", "colours", "plain"), ("as it is", "pieces")),
    Exporter(programs.qcad, ("names", "colours", "dashes"), ("as it is", "pieces")),
    Exporter(programs.autocad, ("names", "colours"), (*_POLYLINES, "dashes")),
    Exporter(programs.rhino, forms=("as it is", "polyline")),
    Exporter(programs.openscad, ("plain",), ("polyline",), closed=True, blank=True),
    Exporter(programs.origami_simulator, ("colours",), ("polyline",)),
    Exporter(programs.oripa, ("colours", "one colour"), ("polyline",), bordered=True),
    Exporter(programs.oriedita, ("colours", "dashes"), ("polyline",), bordered=True),
    Exporter(programs.rabbit_ear, ("colours",), ("polyline",), bordered=True),
    Exporter(programs.laser, ("names", "one colour"), ("as it is", "pieces"), bordered=True),
    Exporter(programs.dvisvgm, _LOOKS, ("as it is", "polyline")),
    Exporter(programs.matplotlib, _LOOKS, ("polyline", "pieces")),
    Exporter(programs.cairo, _LOOKS, ("as it is", "pieces")),
    Exporter(programs.p5, ("colours", "plain", "one colour"), FORMS),
    Exporter(programs.processing, _LOOKS, ("as it is", "pieces", "dashes")),
    Exporter(programs.svgwrite, _LOOKS, ("as it is", "pieces")),
    Exporter(programs.potrace, ("plain",), ("as it is",), closed=True),
    Exporter(fold_files.rabbit_ear_fold, ("colours", "one colour"), ("polyline",), closed=True),
    Exporter(fold_files.simulator_fold, ("colours",), ("polyline",), closed=True),
    Exporter(fold_files.oriedita_fold, ("colours", "one colour"), ("polyline",), closed=True),
    Exporter(fold_files.frames_fold, ("colours",), ("polyline",), closed=True),
)  # fmt: skip
#: Of so many files one has several sheets.
_ONE_IN = 12


@dataclass(frozen=True, eq=False)
class Stranger:
    """A file and its author's meaning."""

    number: int
    exporter: str
    designs: tuple[str, ...]
    habits: Habits
    export: Export
    sheets: tuple[MeantSheet, ...]

    @property
    def file_name(self) -> str:
        return f"{self.number:04d}_{self.exporter}{self.export.suffix}"

    def words(self) -> str:
        return f"{self.exporter}: {' + '.join(self.designs)}; {self.habits.words()}"

    def write(self, folder: Path) -> Path:
        path = folder / self.file_name
        path.write_text(self.export.text, encoding="utf-8")
        return path

    def faults(self, read: Sequence[CreasePattern] | Exception) -> list[str]:
        """What is wrong with what was read, or with the refusal."""
        wanted = self.export.refused
        if isinstance(read, Exception):
            if wanted:
                return [] if wanted in str(read) else [f"refused without a word about {wanted} shapes: {read}"]
            return [f"refused: {getattr(read, 'message', read)}"]
        if wanted:
            return [f"read, though all of it is {wanted} shapes"]
        return faults(self.sheets, self.export.unit, self.export.unit_mm, read)


def stranger(number: int) -> Stranger:
    rng = np.random.default_rng([number, 71])
    exporter = EXPORTERS[number % len(EXPORTERS)]
    turn = number // len(EXPORTERS)
    designs = [DESIGNS[(turn + 3 * number) % len(DESIGNS)](rng)]
    if number % _ONE_IN == _ONE_IN - 1 and not exporter.blank:
        designs += [DESIGNS[rng.integers(len(DESIGNS))](rng) for _ in range(rng.integers(1, 3))]
    habits = _habits(exporter, rng, designs)
    layout = lay_out(designs, habits, rng)
    export = exporter.write(layout.page, look(rng, habits.marks), rng)
    sheets = layout.sheets
    if exporter.blank:
        sheets = tuple(MeantSheet(one.outline, one.holes, (), ()) for one in sheets)
    return Stranger(number, exporter.name, tuple(design.name for design in designs), habits, export, sheets)


def _habits(exporter: Exporter, rng: Rng, designs: list[Design]) -> Habits:
    habits = habits_of(rng, designs, exporter.marks, exporter.forms, not exporter.bordered)
    if not exporter.closed:
        return habits
    return Habits("closed", habits.form, habits.marks, sheets=len(designs))
