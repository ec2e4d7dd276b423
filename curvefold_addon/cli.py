"""``blender --command curvefold fold …``, ``… batch …``, ``… verify …`` and ``… plan …``.

With the bpy module instead of a Blender program, ``python -m curvefold_addon fold …`` in a checkout
calls the same ``main``.
"""

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path

import bpy

from .. import solver
from ..solver import command_line
from ..solver.console import every_word_printable
from ..solver.files.writable import check_writable
from . import batch, interrupts, line_materials, paper_material, scene
from .bridge import line_objects, mesh, papers
from .whole_files import OutputError, whole_file

COMMAND = "curvefold"
EXIT_BAD_INPUT = 2

_command = None


def main(argv: list[str]) -> int:
    """Runs ``fold …``, ``batch …``, ``verify …`` or ``plan …`` and returns the exit code, also after Ctrl-C."""
    try:
        with interrupts.said_once(), every_word_printable():
            return _main(argv)
    except KeyboardInterrupt:
        interrupts.say()
        return interrupts.INTERRUPTED


def _main(argv: list[str]) -> int:
    try:
        arguments, rest = _parser().parse_known_args(argv)
        if rest and arguments.run is not run_batch:
            _parser().parse_args(argv)  # says which argument is unknown
        return int(arguments.run(arguments, rest))
    except SystemExit as stop:  # argparse has said why
        return stop.code if isinstance(stop.code, int) else EXIT_BAD_INPUT
    except (OutputError, batch.BatchError, solver.CurvefoldError) as error:
        print(f"{COMMAND}: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT


def fold_parser(parser: argparse.ArgumentParser) -> argparse.ArgumentParser:
    """The arguments of ``fold``: the solver's own, and what Blender adds to them."""
    parser.add_argument(
        "pattern", metavar="PATTERN", help=f"the drawing to fold ({', '.join(solver.DRAWING_SUFFIXES)})"
    )
    parser.add_argument("--out", required=True, metavar="DIR", help="where the results go")
    command_line.add_fold_arguments(parser)
    parser.add_argument("--render", metavar="PNG", type=_path_ending(".png"), help="render a picture in Cycles")
    parser.add_argument("--blend", metavar="FILE", type=_path_ending(".blend"), help="save the scene")
    parser.add_argument("--size", metavar="WxH", type=_size, default=(1600, 1000), help="pixels (1600x1000)")
    parser.add_argument("--samples", type=_positive, default=24, help="Cycles samples per pixel (24)")
    parser.add_argument("--threads", type=_not_negative, default=0, help="render threads (0: every core)")
    return parser


def run_fold(arguments: argparse.Namespace, rest: list[str]) -> int:
    """Folds one drawing, then renders and saves what was asked for."""

    def on_result(result: solver.FoldResult, folder: object) -> None:
        if arguments.render or arguments.blend:
            with interrupts.end_at_once():
                _show(result, arguments)

    # Before the folding, which may take long.
    for path in (arguments.render, arguments.blend):
        if path is not None:
            check_writable(path.parent, [path.name])
    return int(command_line.run_fold(arguments, sys.stderr, on_result=on_result))


def run_batch(arguments: argparse.Namespace, rest: list[str]) -> int:
    """Folds every drawing of a folder or a list."""
    # What batch itself does not know belongs to fold; a mistake must not come up once for every drawing.
    told = fold_parser(argparse.ArgumentParser(prog=f"{COMMAND} batch")).parse_args(
        ["drawing.svg", "--out", arguments.out, *rest]
    )
    command_line.description_of(told)
    return batch.run(
        Path(arguments.source),
        Path(arguments.out),
        jobs=arguments.jobs,
        render=arguments.render,
        options=rest,
        reading=command_line.read_options_of(told),
    )


def run_verify(arguments: argparse.Namespace, rest: list[str]) -> int:
    """Checks whether a folded mesh is paper."""
    return int(command_line.run_verify(arguments, sys.stderr))


def run_plan(arguments: argparse.Namespace, rest: list[str]) -> int:
    """Writes the flat sheet for a machine or a hand."""
    return int(command_line.run_plan(arguments, sys.stderr))


def _show(result: solver.FoldResult, arguments: argparse.Namespace) -> None:
    # An empty file, whatever the user's start-up file holds; the extension stays enabled.
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    paper = mesh.add_paper(result, bpy.context.scene.collection, paper_material.paper_material())
    papers.keep(paper, result)
    width, height = arguments.size
    scene.set_up(paper, scene.PictureSettings(width, height, arguments.samples, arguments.threads))
    if arguments.rulings:
        _add_rulings(paper, result)
    if arguments.render:
        with whole_file(arguments.render) as partial, interrupts.end_at_once(partial):
            scene.render(str(partial))
    if arguments.blend:
        with whole_file(arguments.blend) as partial, interrupts.end_at_once(*_written(partial)):
            bpy.ops.wm.save_as_mainfile(
                filepath=str(partial), check_existing=False, copy=True, compress=True, relative_remap=False
            )


def _written(blend: Path) -> tuple[Path, Path]:
    """A file that is saved, and the one beside it that Blender writes first."""
    return blend, blend.with_name(f"{blend.name}@")


def _add_rulings(paper: bpy.types.Object, result: solver.FoldResult) -> None:
    """Rulings, which the picture shows, and the Gauss image beside the paper, which it does not."""
    net, positions = line_objects.in_metres(result)
    line_objects.add_rulings(paper, net, positions, line_materials.of_rulings())
    image = line_objects.add_gauss_image(paper, net, positions, line_materials.of_gauss_images())
    image.hide_render = True


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=COMMAND, description="Folds paper along curves.", allow_abbrev=False)
    command_line.add_version_argument(parser)
    commands = parser.add_subparsers(title="commands", required=True, metavar="fold | batch | verify | plan")
    fold = commands.add_parser(
        "fold", help="fold one drawing", description="Folds one drawing.", allow_abbrev=False
    )
    fold_parser(fold).set_defaults(run=run_fold)
    many = commands.add_parser(
        "batch",
        help="fold every drawing of a folder or a list",
        description="Folds every drawing of a folder or a list, each sheet in its own folder. "
        "Other options go to fold. What is finished already is skipped.",
        allow_abbrev=False,
    )
    many.add_argument("source", metavar="FOLDER|LIST", help="a folder of drawings, or a text file with one a line")
    many.add_argument("--out", required=True, metavar="DIR", help="where the folders of results go")
    many.add_argument("--jobs", type=_positive, default=1, help="drawings folded at the same time (1)")
    many.add_argument("--render", action="store_true", help="render every fold")
    many.set_defaults(run=run_batch)
    check = commands.add_parser(
        "verify",
        help="check whether a folded mesh is paper",
        description="Checks whether a folded mesh, with its flat sheet beside it, is paper.",
        allow_abbrev=False,
    )
    command_line.add_verify_arguments(check)
    check.set_defaults(run=run_verify)
    sheet = commands.add_parser(
        "plan",
        help="write the flat sheet for a machine or a hand",
        description="Writes the flat sheet of a drawing or a fold as SVG, DXF or PDF.",
        allow_abbrev=False,
    )
    command_line.add_plan_arguments(sheet)
    sheet.set_defaults(run=run_plan)
    return parser


def _path_ending(suffix: str) -> Callable[[str], Path]:
    def path(text: str) -> Path:
        if Path(text).suffix.lower() != suffix:
            raise argparse.ArgumentTypeError(f"{text!r} does not end in {suffix}")
        # Blender has its own idea of what a relative path is relative to.
        return Path(text).absolute()

    return path


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of at least 1")
    return int(text)


def _not_negative(text: str) -> int:
    return 0 if text == "0" else _positive(text)


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 1600x1000")
    return int(match[1]), int(match[2])


def register() -> None:
    global _command
    _command = bpy.utils.register_cli_command(COMMAND, main)


def unregister() -> None:
    global _command
    if _command is not None:
        bpy.utils.unregister_cli_command(_command)
    _command = None
