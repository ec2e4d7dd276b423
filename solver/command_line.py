"""The command line, shared by ``python -m solver`` and by Blender's ``--command curvefold``."""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TextIO

from .console import every_word_printable
from .description import AUTO, FoldDescription, read_description, read_handles
from .errors import CurvefoldError
from .files.mesh_reading import read_mesh
from .files.results import FOLD_NAME, result_names, write_results
from .files.ruling_files import RULINGS_SVG
from .files.writable import check_writable
from .fold import FoldResult, fold, in_words
from .folding import SqpReport
from .pattern.read_options import BORDERS, UNITS_MM, ReadOptions
from .pattern.reading import DRAWING_SUFFIXES, read_pattern
from .plan.planning import PlanDescription, check_grooves, plan, write_plan
from .plan.profile import PAPERS, profile_names, read_profile
from .plan.source import plan_sources, read_plan_source
from .plan.writing import PENS, check_place
from .verify_mesh import verdict, verify_mesh
from .version import in_words as version_in_words

#: Exit codes: everything asked was reached, or a mesh is paper; folded, but not all that was asked, or a mesh is no
#: paper; the input cannot be used.
REACHED, NOT_REACHED, BAD_INPUT = 0, 1, 2
#: The exit code after Ctrl-C, as shells have it: 128 and the number of the signal.
INTERRUPTED = 130
#: Seconds between two lines of progress.
_PROGRESS_SECONDS = 1.0

OnResult = Callable[[FoldResult, Path], None]


def add_fold_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``fold``, without the drawing's and the output's own."""
    default = FoldDescription()
    parser.add_argument(
        "--description", metavar="FILE.json",
        help="a whole fold description with handles, weights and controls, as report.json has it under "
        "'description'; the other options go before it",
    )  # fmt: skip
    parser.add_argument(
        "--resolution", type=_resolution, default=None, metavar="N",
        help="quads along the sheet's longer side, or auto for as many as the drawing needs "
        f"(default {default.resolution})",
    )  # fmt: skip
    parser.add_argument(
        "--vertices", type=int, default=None, metavar="N",
        help=f"vertices that an automatic resolution may use (default {default.max_vertices})",
    )  # fmt: skip
    parser.add_argument(
        "--handles", metavar="FILE.json",
        help='handles: [{"at": [x, y], "target": [X, Y, Z]}, …] in the drawing\'s units',
    )  # fmt: skip
    parser.add_argument(
        "--angle", type=float, default=None, metavar="DEG",
        help="fold every crease to this angle (default 60 without handles, no drive with them)",
    )  # fmt: skip
    parser.add_argument(
        "--least-fold", type=float, default=None, metavar="DEG",
        help="with handles alone, fold every crease at least so far; 0 leaves creases to the handles "
        f"(default {default.least_fold:g})",
    )  # fmt: skip
    parser.add_argument(
        "--assignments", choices=("free", "bind"), default=None,
        help=f"whether the drawing's mountains and valleys bind the fold (default {default.assignments})",
    )  # fmt: skip
    parser.add_argument(
        "--rulings", action="store_true",
        help="write the rulings (rulings.obj, rulings.svg) and the Gauss image (gauss_image.obj) too",
    )  # fmt: skip
    parser.add_argument(
        "--plan", choices=[suffix.removeprefix(".") for suffix in PENS], default=None,
        help="write the plan of the folded sheet too: plan.svg, plan.dxf or plan.pdf, for a machine or a hand",
    )  # fmt: skip
    _add_profile_argument(parser)
    _add_read_arguments(parser)


def _add_profile_argument(parser: argparse.ArgumentParser) -> None:
    default = PlanDescription().profile
    parser.add_argument(
        "--profile", default=default, metavar="NAME",
        help=f"what a plan is for: {', '.join(profile_names())}, or a file *.toml (default {default})",
    )  # fmt: skip


def add_version_argument(parser: argparse.ArgumentParser) -> None:
    """``--version``: which Curvefold this is, and what solves its linear systems."""
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and what computes, and exit")


class _Version(argparse.Action):
    """Finds out what to print only when it is asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        print(version_in_words())
        parser.exit()


def _add_read_arguments(parser: argparse.ArgumentParser) -> None:
    """How the drawing is read: one argument for each field of ``ReadOptions``."""
    default = ReadOptions()
    parser.add_argument(
        "--border", choices=BORDERS, default=default.border,
        help="what the sheet is: the outline that is drawn, or the drawing's page "
        f"(default {default.border}: the page where no outline is drawn)",
    )  # fmt: skip
    parser.add_argument(
        "--sheet", type=int, default=default.sheet, metavar="N",
        help="which sheet of a drawing that has several, counted from 1 (default: the first)",
    )  # fmt: skip
    parser.add_argument(
        "--unit", default=default.unit, metavar="UNIT",
        help=f"what one unit of the drawing is: {', '.join(UNITS_MM)}, or dots to the inch such as 90dpi "
        "(default: what the file says)",
    )  # fmt: skip
    parser.add_argument(
        "--scale", type=float, default=default.scale, metavar="FACTOR",
        help=f"factor on the drawing's size (default {default.scale:g})",
    )  # fmt: skip


def _resolution(text: str) -> int | str:
    if text == AUTO:
        return AUTO
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number, and not {AUTO!r}") from None


def description_of(args: argparse.Namespace) -> FoldDescription:
    """What the arguments ask for. Raises CurvefoldError on a bad file or number."""
    told = read_description(args.description) if args.description else FoldDescription()
    given: dict[str, Any] = {}
    if args.handles:
        given["handles"] = read_handles(args.handles)
        if not args.description:
            given["angle"] = None
    for option, name in (
        ("resolution",) * 2,
        ("vertices", "max_vertices"),
        ("angle",) * 2,
        ("least_fold",) * 2,
        ("assignments",) * 2,
    ):
        if getattr(args, option) is not None:
            given[name] = getattr(args, option)
    return replace(told, **given)


def read_options_of(args: argparse.Namespace) -> ReadOptions:
    """How the arguments have the drawing read. Raises DescriptionError on a bad value."""
    return ReadOptions(args.border, args.sheet, args.unit, args.scale)


def run_fold(args: argparse.Namespace, stream: TextIO, on_result: OnResult | None = None) -> int:
    """Read, fold, write; progress and summary to ``stream``. Returns the exit code, raises nothing of ours.

    args: pattern, out, and what ``add_fold_arguments`` added. on_result(result, folder) may write more.
    """
    said: tuple[str, ...] = ()
    try:
        folder = Path(args.out)
        _check_apart(Path(args.pattern), folder)
        planned = None if args.plan is None else folder / f"plan.{args.plan}"
        if planned is not None:
            check_place(planned, [args.pattern])
        asked = PlanDescription(read_profile(args.profile) if planned else "origami", rulings=args.rulings)
        check_grooves(asked)
        description = description_of(args)
        check_writable(folder, result_names(args.rulings))
        pattern = read_pattern(args.pattern, read_options_of(args))
        # Before the fold, which may take long: whoever sees that the drawing was misread need not wait for it.
        said = pattern.notes
        _print_notes(said, stream)
        try:
            result = fold(pattern, description, _progress(stream))
        except CurvefoldError as error:
            source = _source(args, error.where.element or "")
            raise error.in_file(str(source)) if error.where.file is None else error from None
        write_results(result, folder, args.rulings)
        if planned is not None:
            write_plan(plan(result, asked), planned, [args.pattern])
        if on_result is not None:
            on_result(result, folder)
    except CurvefoldError as error:
        return _refuse(error, stream, said)
    _print_notes(result.net.notes, stream)
    print(result.summary(), file=stream)
    return REACHED if result.status.ok else NOT_REACHED


def add_verify_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``verify``."""
    parser.add_argument("mesh", metavar="FILE", help="a folded mesh with its flat sheet (.obj, .fold)")
    parser.add_argument("--json", action="store_true", help="print what was found as JSON, figures and faults")


def run_verify(args: argparse.Namespace, stream: TextIO) -> int:
    """Check a folded mesh: a sentence, then its faults, to ``stream``; JSON to the standard output.

    args: what ``add_verify_arguments`` added. Returns the exit code, raises nothing of ours.
    """
    try:
        found = verify_mesh(read_mesh(args.mesh))
    except CurvefoldError as error:
        return _refuse(error, stream)
    if args.json:
        print(json.dumps(found.to_json(), indent=1, allow_nan=False))
    else:
        print(f"{args.mesh} is {verdict(found)}", file=stream)
        for fault in found.faults[1:]:
            print(f"also: {fault}", file=stream)
    return REACHED if found.ok else NOT_REACHED


def add_plan_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``plan``."""
    parser.add_argument(
        "source", metavar="DRAWING|FOLDED.fold|FOLDER",
        help="a drawing, a folded FOLD file, or a folder of results: of these mountains and valleys are as folded",
    )  # fmt: skip
    parser.add_argument(
        "--out", required=True, metavar="FILE",
        help=f"the file to write ({', '.join(PENS)}); several pages are several files, or one PDF",
    )  # fmt: skip
    _add_profile_argument(parser)
    parser.add_argument(
        "--thickness", type=float, default=None, metavar="MM",
        help="thickness of board: V-grooves as wide as the fold needs (profile board)",
    )  # fmt: skip
    parser.add_argument(
        "--dash", type=_dashes, default=None, metavar="MM,MM",
        help="dash and gap of all creases, or dash, gap, dot and gap, or none for whole lines "
        "(default: the profile's)",
    )  # fmt: skip
    parser.add_argument(
        "--tile", choices=tuple(PAPERS), default=None,
        help="print it in pieces on this paper, with marks to join them",
    )  # fmt: skip
    parser.add_argument(
        "--tabs", type=float, default=None, metavar="MM",
        help="add tabs of this width where a folder of results has glued borders",
    )  # fmt: skip
    parser.add_argument("--rulings", action="store_true", help="draw the rulings of a folder of results")
    _add_read_arguments(parser)


def run_plan(args: argparse.Namespace, stream: TextIO) -> int:
    """Write the plan of a drawing or a fold; notes and the files' names to ``stream``.

    args: what ``add_plan_arguments`` added. Returns the exit code, raises nothing of ours.
    """
    said: tuple[str, ...] = ()
    try:
        told = PlanDescription(args.profile, args.thickness, args.dash, args.tile, args.tabs, args.rulings)
        source = read_plan_source(args.source, read_options_of(args))
        said = source.notes
        _print_notes(said, stream)
        files = write_plan(plan(source, told), args.out, plan_sources(args.source))
    except CurvefoldError as error:
        if error.where.file is None and error.where.element is not None:
            error = error.in_file(str(args.source))
        return _refuse(error, stream, said)
    for path in files:
        print(f"wrote {path}", file=stream)
    return REACHED


def _dashes(text: str) -> tuple[float, ...]:
    if text == "none":
        return ()
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no lengths such as 3,1.5, and not 'none'") from None


def _refuse(error: CurvefoldError, stream: TextIO, said: Sequence[str] = ()) -> int:
    """What was decided before it went wrong, apart from what is said already, then what went wrong."""
    _print_notes((note for note in error.notes if note not in said), stream)
    print(in_words(error), file=stream)
    return BAD_INPUT


def _print_notes(notes: Iterable[str], stream: TextIO) -> None:
    for note in dict.fromkeys(notes):
        print(f"note: {note}", file=stream)


def _check_apart(drawing: Path, folder: Path) -> None:
    """Raises CurvefoldError when a result would be written over the drawing."""
    if os.path.realpath(drawing) in {os.path.realpath(folder / name) for name in (FOLD_NAME, RULINGS_SVG)}:
        raise CurvefoldError("the result would be written over it; choose another folder", file=str(drawing))


def _source(args: argparse.Namespace, element: str) -> str:
    """The file that an element of an error comes from."""
    if "handle" in element and args.handles:
        return str(args.handles)
    if args.description and ("handle" in element or "control" in element):
        return str(args.description)
    return str(args.pattern)


def _progress(stream: TextIO) -> Callable[[int, SqpReport], None]:
    last = [time.monotonic()]

    def show(iterations: int, report: SqpReport) -> None:
        now = time.monotonic()
        if now - last[0] < _PROGRESS_SECONDS:
            return
        last[0] = now
        print(f"{iterations} iterations: {report.status.sentence}", file=stream, flush=True)

    return show


def main(argv: list[str] | None, stream: TextIO) -> int:
    """``python -m solver``: without Blender. Returns the exit code, also after Ctrl-C."""
    parser = argparse.ArgumentParser(prog="python -m solver", description="Fold paper along curves.")
    add_version_argument(parser)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("fold", help="fold a drawing and write OBJ, FOLD and a report")
    command.add_argument("pattern", metavar="PATTERN", help=f"the drawing to fold ({', '.join(DRAWING_SUFFIXES)})")
    command.add_argument("--out", required=True, metavar="DIR", help="folder for the results")
    add_fold_arguments(command)
    command.set_defaults(run=run_fold)
    command = commands.add_parser("verify", help="check whether a folded mesh is paper")
    add_verify_arguments(command)
    command.set_defaults(run=run_verify)
    command = commands.add_parser("plan", help="write the flat sheet for a machine or a hand: SVG, DXF or PDF")
    add_plan_arguments(command)
    command.set_defaults(run=run_plan)
    try:
        with every_word_printable():
            arguments = parser.parse_args(argv)
            return int(arguments.run(arguments, stream))
    except KeyboardInterrupt:
        print("interrupted", file=stream)
        return INTERRUPTED
