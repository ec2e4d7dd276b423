"""Folds every sample pattern, by the angle drive and by its handle file, and prints what was reached.

Run it: python -m benchmarks.samples [--jobs 2] [--only NAME ...] [--write]
With --write the table goes into README.md and sample_patterns/README.md, between their markers, and a picture
of each sample into sample_patterns/pictures. Needs pillow (requirements/dev.txt).
"""

from __future__ import annotations

import argparse
import io
import multiprocessing
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

import solver
from benchmarks.marked import write_between
from solver.arrays import FloatArray
from solver.fold import fold_angle_quantiles

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "sample_patterns"
PICTURES = FOLDER / "pictures"
#: Files that hold the table between these lines.
WITH_TABLE = (ROOT / "README.md", FOLDER / "README.md")
#: Name of the marked part of both READMEs.
MARK = "samples"
HEADER = (
    "sample", "folded by", "vertices", "iterations", "seconds", "mean stretch", "max stretch",
    "fold angle 10 / 50 / 90 %", "folded", "DOG residual", "status",
)  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One line of the table: a sample folded in one way. Stretch relative, angles in degrees."""

    name: str
    way: str
    vertices: int
    iterations: int
    seconds: float
    stretch_mean: float
    stretch_max: float
    angles: tuple[float, float, float]
    folded: float
    residual: float
    status: str
    ok: bool

    def cells(self) -> tuple[str, ...]:
        """The texts of the line, in the order of HEADER."""
        return (
            self.name, self.way, str(self.vertices), str(self.iterations), f"{self.seconds:.1f}",
            f"{self.stretch_mean:.1e}", f"{self.stretch_max:.1e}",
            " / ".join(f"{angle:.0f}°" for angle in self.angles),
            f"{self.folded:.1%}", f"{self.residual:.0e}", self.status,
        )  # fmt: skip


#: Quads along the longer side of a sample: one number for all, so that figures of one day compare with another's.
RESOLUTION = 32


def sample_names() -> list[str]:
    """Names of all sample patterns, in alphabetical order."""
    return sorted(path.stem for path in FOLDER.glob("*.svg"))


def description(name: str, way: str, resolution: int | None = None) -> solver.FoldDescription:
    """How a sample is folded: way "drive" or "handles"; resolution None for RESOLUTION."""
    resolution = resolution or RESOLUTION
    if way == "drive":
        return solver.FoldDescription(resolution=resolution)
    handles = solver.read_handles(FOLDER / f"{name}.handles.json")
    return solver.FoldDescription(resolution=resolution, angle=None, handles=handles)


def fold_sample(job: tuple[str, str], pictures: bool) -> tuple[Row, bytes]:
    """Fold one sample in one way; its line, and its picture as PNG where one is wanted (else empty)."""
    name, way = job
    result = solver.fold(solver.read_pattern(FOLDER / f"{name}.svg"), description(name, way))
    m = result.measurement
    row = Row(
        name, way, len(result.net.rest), result.iterations, result.seconds,
        float(m.stretch.mean()), float(m.stretch.max()), fold_angle_quantiles(m), m.folded_part,
        result.last.constraint, result.status.name.lower().replace("_", " "), result.status.ok,
    )  # fmt: skip
    return row, png(picture(result)) if pictures and way == "drive" else b""


def fold_all(names: Sequence[str], jobs: int, pictures: bool) -> Iterator[tuple[Row, bytes]]:
    """Fold the named samples in both ways, in ``jobs`` processes of one thread each."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read by the processes started below
    todo = [(name, way) for name in names for way in ("drive", "handles")]
    with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        yield from pool.map(partial(fold_sample, pictures=pictures), todo)


def markdown(rows: Sequence[Row]) -> str:
    """The table of all lines."""
    lines = [HEADER, ("---",) * 2 + ("--:",) * 5 + ("---",) + ("--:",) * 2 + ("---",)]
    lines += [row.cells() for row in rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


# --- pictures -------------------------------------------------------------------------------------------

#: Size of one half of a picture, and how much finer it is painted before it is scaled down.
WIDTH, HEIGHT, FINER = 360, 300, 3
#: Part of a half that the sheet fills.
_FILLED = 0.86
BACKGROUND, SHADOW = (233, 231, 226), (112, 110, 116)
FRONT, BACK = (252, 249, 241), (222, 118, 78)
CREASE_LINE, INK = (64, 56, 54), {"M": (200, 30, 44), "V": (28, 84, 200), "U": (132, 62, 176), "F": (150, 150, 150)}
#: Where the sheet is seen from: turned about the vertical, and from above, degrees. Some show more otherwise.
TURN, TILT = -35.0, 42.0
VIEWS = {
    "cusp": (-60.0, 52.0), "hairpin": (-60.0, 52.0), "loop": (-52.0, 54.0), "star": (-64.0, 54.0),
    "miura": (35.0, 40.0), "crossing": (-60.0, 50.0), "circle_in_square": (-55.0, 48.0), "lens": (-50.0, 50.0),
}  # fmt: skip
#: Direction to the light (x right, y away, z up, after the turn), and its ambient part.
LIGHT, AMBIENT = np.array([-0.75, -0.35, 0.75]) / np.linalg.norm([-0.75, -0.35, 0.75]), 0.32
#: Crease lines are painted as if this much nearer, part of the sheet's size: not half hidden by their faces.
_LINE_LIFT = 0.015


def picture(result: solver.FoldResult) -> Image.Image:
    """The flat drawing beside the folded sheet."""
    whole = Image.new("RGB", (2 * WIDTH * FINER, HEIGHT * FINER), BACKGROUND)
    whole.paste(_flat_half(result.pattern), (0, 0))
    whole.paste(_folded_half(result), (WIDTH * FINER, 0))
    return whole.resize((2 * WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def png(image: Image.Image) -> bytes:
    """A small PNG: 220 colours are enough for paper."""
    stream = io.BytesIO()
    image.quantize(220, dither=Image.Dither.NONE).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _pixels(points: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Points (N,2), y up, to pixels of one half, so that the box low..high fills it."""
    size = np.array([WIDTH, HEIGHT]) * FINER
    scale = float((_FILLED * size / np.maximum(high - low, 1e-12)).min())
    return np.asarray(size / 2 + (points - (low + high) / 2) * scale * np.array([1.0, -1.0]))


def _corners(points: FloatArray) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in points]


def _flat_half(pattern: solver.CreasePattern) -> Image.Image:
    image = Image.new("RGB", (WIDTH * FINER, HEIGHT * FINER), BACKGROUND)
    draw = ImageDraw.Draw(image)
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    for ring, fill in ((pattern.boundary, FRONT), *((hole, BACKGROUND) for hole in pattern.holes)):
        outline = _corners(_pixels(ring, low, high))
        draw.polygon(outline, fill=fill)
        draw.line([*outline, *outline[:2]], fill=(0, 0, 0), width=FINER, joint="curve")
    for crease in pattern.creases:
        points = np.vstack([crease.points, crease.points[:1]]) if crease.closed else crease.points
        line = _corners(_pixels(points, low, high))
        draw.line(line, fill=INK[crease.assignment], width=2 * FINER, joint="curve")
    return image


def _folded_half(result: solver.FoldResult) -> Image.Image:
    """Flat shaded polygons from back to front, with a soft shadow on the ground."""
    surface = result.net.render_map
    x = _laid_down(surface.apply(result.positions), surface.uv)
    turn, tilt = np.radians(VIEWS.get(result.pattern.name, (TURN, TILT)))
    x = x @ np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    x[:, 2] -= x[:, 2].min()
    shadow = x - LIGHT * (x[:, 2:] / LIGHT[2])
    project = np.array([[1.0, 0.0], [0.0, np.sin(tilt)], [0.0, np.cos(tilt)]])
    seen, cast = x @ project, shadow @ project
    both = np.vstack([seen, cast])
    low, high = both.min(axis=0), both.max(axis=0)
    seen, cast = _pixels(seen, low, high), _pixels(cast, low, high)
    faces = surface.faces()

    image = Image.new("RGB", (WIDTH * FINER, HEIGHT * FINER), BACKGROUND)
    mask = Image.new("L", image.size, 0)
    on_mask = ImageDraw.Draw(mask)
    for face in faces:
        on_mask.polygon(_corners(cast[face]), fill=105)
    image.paste(SHADOW, mask=mask.filter(ImageFilter.GaussianBlur(4 * FINER)))

    towards = np.array([0.0, -np.cos(tilt), np.sin(tilt)])
    lift = _LINE_LIFT * float(np.ptp(x, axis=0).max())
    parts = [(float(x[face].mean(axis=0) @ towards), face, _shade(x[face], towards)) for face in faces]
    parts += [(float(x[e].mean(axis=0) @ towards) + lift, e, CREASE_LINE) for e in surface.crease_edges]
    draw = ImageDraw.Draw(image)
    for _, corners, colour in sorted(parts, key=lambda part: part[0]):
        outline = _corners(seen[corners])
        if len(outline) == 2:
            draw.line(outline, fill=colour, width=FINER)
        else:
            draw.polygon(outline, fill=colour, outline=colour)
    return image


def _laid_down(x: FloatArray, uv: FloatArray) -> FloatArray:
    """x (N,3) moved rigidly as near as it can be to the flat sheet uv (N,2): right stays right, front up."""
    flat = np.column_stack([uv - uv.mean(axis=0), np.zeros(len(uv))])
    x = x - x.mean(axis=0)
    u, _, vt = np.linalg.svd(x.T @ flat)
    u[:, 2] *= np.sign(np.linalg.det(u @ vt))
    return np.asarray(x @ u @ vt)


def _shade(corners: FloatArray, towards: FloatArray) -> tuple[int, int, int]:
    """Colour of a polygon (N,3) in space: its side, and how it stands to the light."""
    arms = corners - corners.mean(axis=0)
    normal = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    normal = normal / max(float(np.linalg.norm(normal)), 1e-300)
    front = float(normal @ towards) > 0
    lit = AMBIENT + (1 - AMBIENT) * max(0.0, float(normal @ LIGHT) * (1 if front else -1))
    red, green, blue = np.clip(np.array(FRONT if front else BACK) * lit, 0, 255).astype(int).tolist()
    return red, green, blue


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.samples", description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=2, help="processes (default %(default)s)")
    parser.add_argument("--only", nargs="+", choices=sample_names(), metavar="NAME", help="these samples")
    parser.add_argument(
        "--write", action="store_true", help="write the pictures and, unless --only is given, the tables"
    )
    args = parser.parse_args()
    rows: list[Row] = []
    widths = (19, 9, 8, 10, 7, 12, 11, 25, 6, 12, 0)
    print("  ".join(text.ljust(width) for text, width in zip(HEADER, widths, strict=True)))
    for row, image in fold_all(args.only or sample_names(), args.jobs, args.write):
        rows.append(row)
        cells = zip(row.cells(), widths, strict=True)
        print("  ".join(text.ljust(width) for text, width in cells), flush=True)
        if image:
            PICTURES.mkdir(exist_ok=True)
            (PICTURES / f"{row.name}.png").write_bytes(image)
    if args.write and not args.only:
        for path in WITH_TABLE:
            write_between(path, MARK, markdown(rows))
    return 0 if all(row.ok for row in rows) else 1


if __name__ == "__main__":
    raise SystemExit(main())
