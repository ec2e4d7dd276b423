"""Hostile input for every door of the solver: made of true files, spoilt, and of pieces that readers stumble on."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import solver
from benchmarks.fuzz_dxf import made_dxf
from benchmarks.fuzz_run import Door
from benchmarks.fuzz_typed import made_cp, made_opx
from solver.files.fold_format import fold_text
from solver.pattern.reading import READERS

FOLDER = Path(__file__).resolve().parents[1] / "sample_patterns"
#: Quads along the longer side of the net that is made of every drawing that can be read.
RESOLUTION = 6
#: The drawing that fold descriptions are tried on: two creases that cross in the middle of a square of 100.
TRIED_ON = FOLDER / "crossing.svg"

_NUMBERS = [
    "0", "-0", "1", "-1", "50", "1e3", "1e-9", "1e308", "-1e308", "1e999", "nan", "inf", "-inf", ".", "-", "1e",
    "0x10", "1.2.3", "١٢", "1,", ",1", "%", "50%", "3mm", "2in", "1em",
]  # fmt: skip
_NUMBERS.append("9" * 400)
_COLOURS = [
    "red", "#f00", "#00f", "black", "none", "url(#g)", "rgb(1,2,3)", "rgb(", "currentColor", "inherit",
    "hsl(1e999,0%,0%)", "#", "#ff", "var(--x)",
    "var(--x, var(--y, red))", "color(display-p3 1 0 0)", "color(", "oklch(1e308 1e308 1turn)",
    "lab(none none 1e999)", "device-cmyk(0 1 1 0)", "#f00 icc-color(a, 1)", "hwb(1e308rad 0% 0%)",
    "red !important", "\\",
]  # fmt: skip
_COLOURS.append("")
_TRANSFORMS = [
    "translate(3)", "scale(0)", "scale(1e200)", "matrix(1 2 3)", "matrix(0 0 0 0 0 0)", "rotate(45 1 1)",
    "skewX(90)", "matrix(1 0 0 1 nan 0)", "scale(-1 1)", "rotate(", "translate(1e308 1e308)",
]  # fmt: skip
_NAMES = [
    "mountain",
    "valley",
    "border",
    "cut",
    "hole",
    "facet",
    "",
    "M",
    "../../x",
    "é",
    "a b c",
    "\x01",
    "]]>",
    "<",
]
_TAGS = ["path", "line", "rect", "circle", "ellipse", "polygon", "polyline", "g", "use", "symbol", "svg", "text",
         "image", "style", "defs", "clipPath", "unknown"]  # fmt: skip
_HEADS = [
    '<?xml version="1.0"?>',
    '<?xml version="1.0" encoding="utf-16"?>',
    "\ufeff",
    "",
    '<!DOCTYPE svg [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]>',
    '<!DOCTYPE svg SYSTEM "file:///etc/passwd">',
]
_ATTRIBUTES = [
    "d", "points", "x", "y", "width", "height", "r", "rx", "cx", "x1", "y2", "stroke", "fill", "style", "class",
    "id", "transform", "href", "viewBox", "stroke-dasharray", "display", "opacity",
]  # fmt: skip


def _attribute(rng: Random) -> str:
    name = rng.choice(_ATTRIBUTES)
    if name == "d":
        value = " ".join(
            rng.choice("MmLlHhVvCcSsQqTtAaZzX") + " " + " ".join(_number(rng) for _ in range(rng.randrange(8)))
            for _ in range(rng.randrange(7))
        )
    elif name in ("points", "viewBox", "stroke-dasharray"):
        value = rng.choice([" ", ","]).join(_number(rng) for _ in range(rng.randrange(9)))
    elif name in ("stroke", "fill"):
        value = rng.choice(_COLOURS)
    elif name == "style":
        value = ";".join(f"{rng.choice(['stroke', 'fill', 'x', ''])}:{rng.choice(_COLOURS)}" for _ in range(3))
    elif name == "transform":
        value = " ".join(rng.choice(_TRANSFORMS) for _ in range(rng.randrange(1, 4)))
    elif name == "href":
        value = rng.choice(
            ["#a", "#b", "", "#", "http://example.invalid/x.svg#a", "file:///etc/passwd", "javascript:1"]
        )
    elif name in ("class", "id"):
        value = rng.choice([*_NAMES, "a", "b"])
    else:
        value = _number(rng)
    quoted = value.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    return f'{name}="{quoted}"'


def _number(rng: Random) -> str:
    return rng.choice(_NUMBERS) if rng.random() < 0.25 else f"{rng.uniform(-20, 120):.{rng.randrange(4)}f}"


def _element(rng: Random, depth: int) -> str:
    tag = rng.choice(_TAGS)
    attributes = " ".join({a.split("=")[0]: a for a in (_attribute(rng) for _ in range(rng.randrange(6)))}.values())
    inside = "".join(_element(rng, depth + 1) for _ in range(rng.randrange(4))) if depth < 4 else ""
    if tag == "style":
        inside = rng.choice(
            [
                ".a{stroke:red}",
                "path{stroke",
                "*{fill:none}",
                "@import url(x);",
                "a b c d e{x:y}" * 20,
                ":root{--x:var(--x)}",
                "g:nth-child(2n+1) ~ [id^='a' i]:not(.a){stroke:blue!important}",
                "@media print{",
                "*{transform:rotate(1e308deg);transform-box:fill-box;transform-origin:50% 1e308px}",
                "a{b:'",
                "@{};:",
            ]
        )
    return f"<{tag} {attributes}>{inside}</{tag}>"


def made_svg(rng: Random) -> bytes:
    """An SVG file out of odd pieces, around a sheet and a crease that would do."""
    good = (
        '<rect width="100" height="100" stroke="black" fill="none"/>'
        '<path d="M0 40 Q50 70 100 40" stroke="red" fill="none"/>'
    )
    body = "".join(_element(rng, 0) for _ in range(rng.randrange(1, 5)))
    space = rng.choice(['xmlns="http://www.w3.org/2000/svg"', ""])
    return (f'{rng.choice(_HEADS)}<svg {space} viewBox="0 0 100 100">{good if rng.random() < 0.7 else ""}{body}'
            f"</svg>").encode(rng.choice(["utf-8", "utf-8", "utf-8", "utf-16", "latin-1"]), "replace")  # fmt: skip


def changed_svg(rng: Random, data: bytes) -> bytes:
    """A drawing with an element or an attribute put in, or bytes spoilt."""
    if rng.random() < 0.3 or b">" not in data:
        return spoilt(rng, data)
    ends = [k for k, byte in enumerate(data) if byte == ord(">")]
    at = rng.choice(ends)
    if rng.random() < 0.5:
        return data[: at + 1] + _element(rng, 2).encode("utf-8", "replace") + data[at + 1 :]
    at -= data[at - 1] == ord("/")
    return data[:at] + b" " + _attribute(rng).encode("utf-8", "replace") + data[at:]


def spoilt(rng: Random, data: bytes) -> bytes:
    """A true file with bytes changed, dropped, repeated or cut off."""
    array = bytearray(data)
    for _ in range(rng.randrange(1, 6)):
        at = rng.randrange(len(array) + 1)
        size = rng.choice([1, 1, 2, 8, 40])
        kind = rng.randrange(5)
        if kind == 0 and array:
            array[at % len(array)] = rng.randrange(256)
        elif kind == 1:
            del array[at : at + size]
        elif kind == 2:
            array[at:at] = array[at : at + size] * rng.choice([1, 2, 30])
        elif kind == 3:
            array[at:at] = rng.choice(_NUMBERS).encode()
        else:
            del array[at + size * 20 :]
    return bytes(array)


def _svg(rng: Random) -> bytes:
    if rng.random() < 0.5:
        return made_svg(rng)
    return spoilt(rng, rng.choice(sorted(FOLDER.glob("*.svg"))).read_bytes())


@cache
def _written(name: str) -> str:
    """The FOLD file of a sample, as it is written of a folded one; folded by hand, which is quicker."""
    rng = Random(name)
    pattern = solver.read_pattern(FOLDER / f"{name}.svg")
    surface = solver.build_net(pattern, 2 * RESOLUTION).render_map
    height = rng.choice([0.0, 0.3]) * np.hypot(*surface.uv.T)
    angles = [rng.choice([-1, 1, 1, 1]) * rng.uniform(0, 90) for _ in surface.crease_edges]
    return fold_text(
        np.column_stack([surface.uv, height]), surface.uv, surface.faces(), surface.crease_edges,
        surface.crease_edge_crease, angles, "mm", pattern.name,
    )  # fmt: skip


def true_fold(rng: Random) -> dict[str, Any]:
    """A FOLD file that is a drawing: ours, or a grid of squares with creases, as other programs may write it."""
    if rng.random() < 0.4:
        names = sorted(path.stem for path in FOLDER.glob("*.svg"))
        return dict(json.loads(_written(rng.choice(names))))
    columns, rows = rng.randrange(2, 7), rng.randrange(2, 7)
    bend = rng.choice([0.0, 0.0, 0.2])
    points = [[x + bend * (y % 2), y + bend * rng.random()] for y in range(rows) for x in range(columns)]
    edges, letters = [], []
    for k in range(columns * rows):
        x, y = k % columns, k // columns
        for other, inside, rim in ((k + 1, x + 1 < columns, y in (0, rows - 1)),
                                   (k + columns, y + 1 < rows, x in (0, columns - 1))):  # fmt: skip
            if inside:
                edges.append([k, other])
                letters.append("B" if rim else rng.choice("MVMVUFCJ" if rng.random() < 0.2 else "MV"))
    faces = [[k, k + 1, k + columns + 1, k + columns] for k in range(columns * (rows - 1)) if (k + 1) % columns]
    frame = {
        "vertices_coords": points,
        "edges_vertices": edges,
        "edges_assignment": letters,
        "faces_vertices": faces,
    }
    for key in ("edges_vertices", "edges_assignment", "faces_vertices"):
        if rng.random() < 0.15:
            del frame[key]
    kind = rng.randrange(4)
    if kind == 0:
        frame["vertices_coords"] = [rng.choice([[x, 0, y], [x, y, 2], [x, y]]) for x, y in points]
    if kind == 1:
        frame["edges_foldAngle"] = [rng.choice([0, 0, None, 90, -90]) for _ in edges]
    if kind == 2:
        frame["edges_curvefold:crease"] = [rng.choice([None, 0, 1, 2]) for _ in edges]
    if rng.random() < 0.3:
        frame = {
            **frame,
            "frame_classes": [rng.choice(["foldedForm", "creasePattern", "graph"])],
            "file_frames": [
                {
                    "frame_parent": rng.choice([0, 0, 1, 2]),
                    "frame_inherit": True,
                    "frame_classes": ["creasePattern"],
                },
                {"vertices_coords": points, "frame_parent": rng.choice([0, 1]), "frame_inherit": True},
            ],
        }
    return frame


def _tampered(rng: Random, data: dict[str, Any]) -> dict[str, Any]:
    """A FOLD file with its geometry spoilt and its types left as they are."""
    data = {key: list(value) if isinstance(value, list) else value for key, value in data.items()}
    points, edges = data.get("vertices_coords"), data.get("edges_vertices")
    for _ in range(rng.randrange(1, 8)):
        kind = rng.randrange(7)
        if kind == 0 and points:
            points[rng.randrange(len(points))] = list(rng.choice(points))
        elif kind == 1 and points:
            at = rng.randrange(len(points))
            points[at] = [v + rng.choice([1e-12, 1e-7, 1e-3, 0.3, 50.0]) * rng.uniform(-1, 1) for v in points[at]]
        elif kind == 2 and edges and points:
            edges[rng.randrange(len(edges))] = [rng.randrange(len(points)), rng.randrange(len(points))]
        elif kind == 3 and edges:
            edges.pop(rng.randrange(len(edges)))
        elif kind == 4 and data.get("edges_assignment"):
            marks = data["edges_assignment"]
            marks[rng.randrange(len(marks))] = rng.choice(["B", "C", "M", "V", "U", "F", "m", "x", "", None])
        elif kind == 5 and edges and points:
            edges.append([rng.randrange(len(points)), rng.randrange(len(points))])
        elif kind == 6 and points and rng.random() < 0.2:
            factor = rng.choice([1e-300, 1e-9, 1e9, 1e12, -1.0])
            points[:] = [[factor * v for v in point] for point in points]
    return data


def made_fold(rng: Random) -> bytes:
    """A FOLD file, changed here and there, with its bytes spoilt or not."""
    data: Any = true_fold(rng)
    kind = rng.randrange(4)
    if kind < 2:
        data = _tampered(rng, data)
    if kind > 0:
        for _ in range(rng.randrange(1, 4)):
            data = changed_json(rng, data)
    text = json.dumps(data).encode()
    return spoilt(rng, text) if rng.random() < 0.1 else text


#: One control of every kind, and more, for TRIED_ON.
CONTROLS: list[dict[str, Any]] = [
    {"kind": "amount", "crease": 1, "part": 0.5},
    {"kind": "side", "crease": 2, "side": "M"},
    {"kind": "angle", "crease": 1, "degrees": 40.0, "signed": True},
    {"kind": "angle", "at": [50.0, 20.0], "degrees": 30.0, "strength": 2.0},
    {"kind": "pair", "first": [10.0, 10.0], "second": [90.0, 10.0], "distance": 50.0},
    {"kind": "pair", "first": [10.0, 10.0], "second": [90.0, 10.0], "axes": [True, False, True]},
    {"kind": "keep", "at": [50.0, 5.0], "shape": "rigid"},
    {"kind": "curve", "crease": 1, "curvature_times": 1.5, "torsion_plus": 0.01, "progress": 0.5},
    {"kind": "curve", "crease": 2, "points": [[0.0, 0.0, 0.0], [50.0, 50.0, 10.0], [90.0, 90.0, 0.0]]},
    {"kind": "glue", "first": [[0.0, 10.0], [0.0, 40.0]], "second": [[100.0, 10.0], [100.0, 40.0]]},
]


def _value(rng: Random, depth: int = 0) -> Any:
    simple = [0, 1, -1, 0.5, 1e308, 10**40, 10**400, float("nan"), float("inf"), True, None, "", "60", "V", [], {}]
    if depth > 3 or rng.random() < 0.6:
        return rng.choice(simple)
    if rng.random() < 0.5:
        return [_value(rng, depth + 1) for _ in range(rng.randrange(4))]
    keys = ["at", "target", "axes", "strength", "kind", "crease", "side", "degrees", "x", "bending", "handles"]
    return {rng.choice(keys): _value(rng, depth + 1) for _ in range(rng.randrange(4))}


def made_handles(rng: Random) -> bytes:
    entries = [{"at": [rng.uniform(0, 9), 1.0], "target": [0.0, 1.0, _value(rng)]} for _ in range(rng.randrange(3))]
    whole: Any = rng.choice(
        [entries, _value(rng), [*entries, _value(rng)], [{"at": _value(rng), "target": _value(rng)}]]
    )
    text = json.dumps(whole)
    return spoilt(rng, text.encode()) if rng.random() < 0.4 else text.encode()


def changed_json(rng: Random, data: Any) -> Any:
    """A JSON value with something in it, at any depth, changed, doubled, renamed or taken away."""
    if not isinstance(data, list | dict) or not data or rng.random() < 0.15:
        return _value(rng)
    copy = list(data) if isinstance(data, list) else dict(data)
    key = rng.randrange(len(copy)) if isinstance(copy, list) else rng.choice(sorted(copy))
    kind = rng.randrange(8)
    if kind == 0:
        del copy[key]
    elif kind == 1 and isinstance(copy, list):
        copy.insert(key, copy[key])
    elif kind == 1 and isinstance(copy, dict):
        copy[rng.choice([*sorted(copy), "unknown"])] = copy.pop(key)
    else:
        copy[key] = changed_json(rng, copy[key])
    return copy


def true_description(rng: Random) -> dict[str, Any]:
    """A description of a fold of TRIED_ON."""
    data = solver.FoldDescription(resolution=RESOLUTION, max_iterations=2).to_json()
    data["controls"] = rng.sample(CONTROLS, rng.randrange(4))
    if rng.random() < 0.5:
        data["handles"] = [{"at": [10.0, 10.0], "target": [20.0, 20.0, 9.0], "strength": 2.0}]
    return data


def made_description(rng: Random) -> bytes:
    data: Any = true_description(rng)
    for _ in range(rng.randrange(1, 4)):
        data = changed_json(rng, data)
    text = json.dumps(data).encode()
    return spoilt(rng, text) if rng.random() < 0.1 else text


# --- what is done with it -------------------------------------------------------------------------------


def _read_drawing(suffix: str) -> Callable[[bytes, Path], None]:
    def use(data: bytes, folder: Path) -> None:
        path = folder / f"drawing{suffix}"
        path.write_bytes(data)
        net = solver.build_net(solver.read_pattern(path), RESOLUTION)
        if wrong := not_sides(net):
            raise AssertionError(f"crease edges that are none of the surface: {wrong}")

    return use


def not_sides(net: solver.PiecewiseDog) -> list[tuple[int, int]]:
    """Edges of creases that are no side of a face of the shown surface."""
    loops = [loop.tolist() for loop in net.render_map.faces()]
    sides = {pair for loop in loops for pair in zip(loop, loop[1:] + loop[:1], strict=True)}
    marked = map(tuple, net.render_map.crease_edges.tolist())
    return [(a, b) for a, b in marked if (a, b) not in sides and (b, a) not in sides]


def _svgz(rng: Random) -> bytes:
    data = gzip.compress(_svg(rng), mtime=0)
    return spoilt(rng, data) if rng.random() < 0.3 else data


def _read_handles(data: bytes, folder: Path) -> None:
    path = folder / "handles.json"
    path.write_bytes(data)
    solver.read_handles(path)


def _read_description(data: bytes, folder: Path) -> None:
    path = folder / "description.json"
    path.write_bytes(data)
    description = solver.read_description(path)
    net = _net()
    model = solver.FoldModel(net, weights=description.weights)
    if description.assignments == "bind":
        model.set_assignments(["M", "V"])
    model.set_controls(description.controls)
    model.set_handles(description.handles)
    model.set_fold_angle(description.angle)
    model.advance(1)
    if not np.isfinite(model.positions).all():
        raise AssertionError("the numbers ran away")


@cache
def _net() -> solver.PiecewiseDog:
    return solver.build_net(solver.read_pattern(TRIED_ON), RESOLUTION)


def _door(name: str, make: Callable[[Random], bytes], use: Callable[[bytes, Path], None]) -> Door:
    return Door(make, use, (solver.CurvefoldError,), frozenset({name}))


def _often_spoilt(make: Callable[[Random], bytes]) -> Callable[[Random], bytes]:
    def made(rng: Random) -> bytes:
        data = make(rng)
        return spoilt(rng, data) if rng.random() < 0.4 else data

    return made


#: Input for every reader of drawings.
MAKERS = {
    ".svg": _svg,
    ".svgz": _svgz,
    ".fold": made_fold,
    ".dxf": _often_spoilt(made_dxf),
    ".cp": _often_spoilt(made_cp),
    ".opx": _often_spoilt(made_opx),
}
DOORS = {
    **{suffix[1:]: _door("drawing", MAKERS[suffix], _read_drawing(suffix)) for suffix in READERS},
    "handles": _door("handles", made_handles, _read_handles),
    "description": _door("description", made_description, _read_description),
}
