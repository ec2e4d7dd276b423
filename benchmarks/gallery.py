"""Folds the gallery: the paper's figures from drawings of our own, with numbers and pictures.

Run it: python -m benchmarks.gallery [--fast] [--only NAME ...] [--blender PYTHON] [--jobs 1] [--resume] [--write]
--blender: the Python of an environment with bpy; it folds through the extension and renders in Cycles.
--write puts the table and the pictures into docs/gallery.md, docs/gallery.json and docs/pictures/gallery.
Needs pillow (requirements/dev.txt).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from benchmarks.gallery_figures import Figure, figures
from benchmarks.samples import BACKGROUND, FINER, FRONT, INK
from solver import CreasePattern, RulingKind, Rulings, fold, rulings
from solver.arrays import FloatArray

ROOT = Path(__file__).resolve().parents[1]
#: Where drawings, descriptions and results of a run lie.
WORK = ROOT / "out" / "gallery"
PAGE, DATA, PICTURES = ROOT / "docs" / "gallery.md", ROOT / "docs" / "gallery.json", ROOT / "docs/pictures/gallery"
#: The paper's own bounds (sections 6.1 and 7): mean stretch, the largest at a point handle and away from handles,
#: mean and largest gap.
BARS = {"stretch_mean": 0.003, "stretch_max": 0.01, "stretch_away": 0.004, "continuity_mean": 2e-4,
        "continuity_max": 3.5e-3}  # fmt: skip
#: Size of a Cycles picture, its samples, and the width of the flat drawing beside it.
WIDTH, HEIGHT, SAMPLES, FLAT_WIDTH = 480, 360, 16, 360
#: Rulings that are parallel, meet in a point, or do neither.
RULING = {
    RulingKind.CYLINDRICAL: (120, 150, 190),
    RulingKind.CONICAL: (190, 150, 60),
    RulingKind.GENERAL: (130, 160, 120),
}
#: Part of its half that the flat drawing fills.
_FILLED = 0.86
INTRODUCTION = """# Gallery

The figures of Rabinovich, Hoffmann and Sorkine-Hornung, *Modeling Curved Folding with Freeform Deformations*
(2019), folded from drawings of our own: patterns like the paper's, not its files. All of it is made by
`python -m benchmarks.gallery --blender PYTHON --write`; the numbers are also in [gallery.json](gallery.json).
Lengths are relative to the mean grid edge, angles in degrees. The paper's bounds are a mean stretch of 0.003, a
largest one of 0.01 at a point handle and of 0.004 away from handles (here: more than three grid edges from every
handle and joined point), a mean gap of 2e-4 and a largest one of 3.5e-3; what misses one of them is **bold**.
"""


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gallery", description=__doc__.splitlines()[0])
    parser.add_argument("--fast", action="store_true", help="only the fast subset")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="only these, by name or number of the figure")
    parser.add_argument("--blender", metavar="PYTHON", help="a Python with bpy: renders each in Cycles")
    parser.add_argument("--jobs", type=int, default=1, help="folds at the same time (default %(default)s)")
    parser.add_argument(
        "--write", action="store_true", help="write docs/gallery.md, docs/gallery.json and pictures"
    )
    parser.add_argument("--resume", action="store_true", help="keep what a stopped run has finished")
    args = parser.parse_args()
    chosen = [f for f in figures() if not args.fast or f.fast]
    if args.only:
        chosen = [f for f in chosen if f.name in args.only or f.figure in args.only]
    rows = []
    with ThreadPoolExecutor(args.jobs) as pool:
        for row in pool.map(lambda figure: fold_figure(figure, args.blender, args.resume), chosen):
            rows.append(row)
            print(line(row), flush=True)
    if args.write:
        known = {
            row["name"]: row for row in (json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else [])
        }
        known |= {row["name"]: row for row in rows}
        shown = [figure for figure in figures() if figure.name in known]
        write(shown, [known[figure.name] for figure in shown])
    barred = [row for row, figure in zip(rows, chosen, strict=True) if figure.bars]
    return 0 if all(row["folded"] == 1.0 and not missed(row) for row in barred) else 1


def fold_figure(figure: Figure, blender: str | None, resume: bool) -> dict[str, Any]:
    """Fold one figure in a process of its own; its row of the table."""
    folder = WORK / figure.name
    folder.mkdir(parents=True, exist_ok=True)
    drawing, told = folder / f"{figure.name}.svg", folder / "description.json"
    if not (resume and _finished(figure, folder, drawing, told, blender is not None)):
        drawing.write_text(svg(figure.pattern), encoding="utf-8")
        told.write_text(_text(figure), encoding="utf-8")
        _run(figure, folder, ["fold", str(drawing), "--out", str(folder), "--description", str(told)], blender)
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    row = {"figure": figure.figure, "name": figure.name}
    row |= {
        name: report[name]
        for name in ("vertices", "iterations", "seconds", "stretch_mean", "stretch_max", "stretch_away")
    }
    row |= {name: report[name] for name in ("continuity_mean", "continuity_max")}
    row |= {"dog_angle": report["dog_angle_max"], "dog_residual": report["dog_residual_max"]}
    row |= {"folded": report["folded"], "fold_angle": report["fold_angle"]}
    row |= {"found": "".join(crease["found"] for crease in report["creases"]), "sentence": report["sentence"]}
    row["weights"] = {k: v for k, v in report["description"]["weights"].items() if v != _WEIGHTS.get(k)}
    return row


def _text(figure: Figure) -> str:
    return json.dumps(figure.description.to_json(), indent=1)


def _finished(figure: Figure, folder: Path, drawing: Path, told: Path, rendered: bool) -> bool:
    """Whether a stopped run has folded this very figure, and rendered it where that is asked."""
    wanted = [drawing, told, folder / "report.json", *([folder / "folded.png"] if rendered else [])]
    if not all(path.exists() for path in wanted):
        return False
    same = drawing.read_text(encoding="utf-8") == svg(figure.pattern)
    return same and told.read_text(encoding="utf-8") == _text(figure)


def _run(figure: Figure, folder: Path, command: list[str], blender: str | None) -> None:
    """Fold in a process of its own. Raises RuntimeError with its last words when it cannot."""
    for old in (folder / "report.json", folder / "folded.png"):
        old.unlink(missing_ok=True)
    if blender is None:
        command = [sys.executable, "-m", "solver", *command]
    else:
        picture = ["--render", str(folder / "folded.png"), "--size", f"{WIDTH}x{HEIGHT}", "--samples", str(SAMPLES)]
        command = [blender, "-m", "curvefold_addon", *command, *picture]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{figure.name} could not be folded: {done.stderr.strip()[-400:]}")


_WEIGHTS = figures()[0].description.to_json()["weights"]


def line(row: dict[str, Any]) -> str:
    """A row as a line for a terminal."""
    low, median, high = row["fold_angle"]
    return (
        f"{row['figure']:>3} {row['name']:<24} {row['vertices']:>6} vertices {row['iterations']:>4} iterations "
        f"{row['seconds']:>6.1f} s  "
        f"stretch {row['stretch_mean']:.1e} {row['stretch_max']:.1e} {row['stretch_away']:.1e}  "
        f"gap {row['continuity_mean']:.1e} {row['continuity_max']:.1e}  DOG {row['dog_residual']:.0e}  "
        f"{row['folded']:.1%}  {low:.0f}/{median:.0f}/{high:.0f}°  {row['found'][:20]}  {row['sentence']}"
    )


# --- files ----------------------------------------------------------------------------------------------


def svg(pattern: CreasePattern) -> str:
    """The drawing as SVG: y down, so that reading turns it back."""
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)

    def path(points: FloatArray, closed: bool, colour: str) -> str:
        turned = np.column_stack([points[:, 0], low[1] + high[1] - points[:, 1]])
        text = "M" + " L".join(f"{x:.9g},{y:.9g}" for x, y in turned) + (" Z" if closed else "")
        return f'<path d="{text}" fill="none" stroke="{colour}" stroke-width="{0.004 * (high[0] - low[0]):.3g}"/>'

    width, height = high - low
    colours = {"M": "#c81e2c", "V": "#1c54c8", "U": "#843eb0", "F": "#969696"}
    rows = [path(ring, True, "#000000") for ring in (pattern.boundary, *pattern.holes)]
    rows += [path(crease.points, crease.closed, colours[crease.assignment]) for crease in pattern.creases]
    box = f"{low[0]:.9g} {low[1]:.9g} {width:.9g} {height:.9g}"
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}">\n' + "\n".join(rows) + "\n</svg>\n"


def write(chosen: Sequence[Figure], rows: Sequence[dict[str, Any]]) -> None:
    """The page, the data, and a picture of each fold that was rendered."""
    text = [INTRODUCTION]
    for number in dict.fromkeys(figure.figure for figure in chosen):
        text.append(f"## Figure {number}\n")
        mine = [(figure, row) for figure, row in zip(chosen, rows, strict=True) if figure.figure == number]
        for figure, _ in mine:
            rendered = WORK / figure.name / "folded.png"
            if rendered.exists():
                PICTURES.mkdir(parents=True, exist_ok=True)
                lines = ruled(figure) if figure.ruled else None
                beside(flat_picture(figure.pattern, lines), rendered).save(
                    PICTURES / f"{figure.name}.png", optimize=True
                )
                text.append(f"![{figure.words}](pictures/gallery/{figure.name}.png)\n")
            text.append(f"{figure.words[0].upper()}{figure.words[1:]}.\n")
        text.append(table(mine))
    PAGE.write_text("\n".join(text), encoding="utf-8")
    DATA.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def table(mine: Sequence[tuple[Figure, dict[str, Any]]]) -> str:
    """A Markdown table of some rows."""
    head = ("name", "vertices", "iterations", "seconds", "stretch mean / max / away",
            "gap mean / max", "DOG residual",
            "folded", "fold angle 10 / 50 / 90 %", "sides", "weights")  # fmt: skip
    lines = [head, ("---", *("--:",) * 9, "---")]
    for figure, row in mine:
        stretch, gap = (
            " / ".join(_bound(row, name, figure.bars) for name in BARS if name.startswith(kind))
            for kind in ("stretch", "continuity")
        )
        weights = ", ".join(f"{k.replace('_', ' ')} {v:g}" for k, v in row["weights"].items()) or "usual"
        lines.append(
            (row["name"], str(row["vertices"]), str(row["iterations"]), f"{row['seconds']:.1f}", stretch, gap,
             f"{row['dog_residual']:.0e}", f"{row['folded']:.1%}",
             " / ".join(f"{angle:.0f}°" for angle in row["fold_angle"]), row["found"], weights)
        )  # fmt: skip
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines) + "\n"


def missed(row: dict[str, Any]) -> list[str]:
    """The figures of a row that are beyond the paper's bounds."""
    return [name for name, bound in BARS.items() if row[name] > bound]


def _bound(row: dict[str, Any], name: str, held: bool) -> str:
    value = f"{row[name]:.1e}"
    return f"**{value}**" if held and name in missed(row) else value


def ruled(figure: Figure) -> Rulings:
    """The rulings of a figure's fold."""
    result = fold(figure.pattern, figure.description)
    return rulings(result.net, result.positions)


def flat_picture(pattern: CreasePattern, lines: Rulings | None = None) -> Image.Image:
    """The drawing, creases in their colours, on a half of its own, with the rulings of a fold if there are any."""
    image = Image.new("RGB", (FLAT_WIDTH * FINER, HEIGHT * FINER), BACKGROUND)
    draw = ImageDraw.Draw(image)
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    size = np.array(image.size)
    scale = float((_FILLED * size / (high - low)).min())

    def pixels(points: FloatArray) -> list[tuple[float, float]]:
        placed = size / 2 + (points - (low + high) / 2) * scale * np.array([1.0, -1.0])
        return [(float(x), float(y)) for x, y in placed]

    for ring, fill in ((pattern.boundary, FRONT), *((hole, BACKGROUND) for hole in pattern.holes)):
        outline = pixels(ring)
        draw.polygon(outline, fill=fill)
        draw.line([*outline, *outline[:2]], fill=(0, 0, 0), width=FINER, joint="curve")
    if lines is not None:
        for ends, kind in zip(lines.flat, lines.kind, strict=True):
            draw.line(pixels(ends), fill=RULING[RulingKind(kind)], width=FINER)
    for crease in pattern.creases:
        points = np.vstack([crease.points, crease.points[:1]]) if crease.closed else crease.points
        draw.line(pixels(points), fill=INK[crease.assignment], width=2 * FINER, joint="curve")
    return image.resize((FLAT_WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def beside(flat: Image.Image, rendered: Path) -> Image.Image:
    """The flat drawing and the picture of the fold side by side, few colours."""
    with Image.open(rendered) as folded:
        whole = Image.new("RGB", (flat.width + folded.width, HEIGHT), BACKGROUND)
        whole.paste(flat, (0, 0))
        whole.paste(folded.convert("RGB"), (flat.width, 0))
    return whole.quantize(220, dither=Image.Dither.FLOYDSTEINBERG)


if __name__ == "__main__":
    raise SystemExit(main())
