"""The FOLD reader: which frame is read, what its edges become, and what is said of files that are none."""

from __future__ import annotations

import io
import itertools
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import solver
from solver.command_line import main
from solver.errors import CurvefoldError, PatternError, ReadError
from solver.pattern import fold_file_frames, fold_file_strokes
from solver.pattern.crease_pattern import CreasePattern
from solver.pattern.curves import sample_crease
from solver.pattern.fold_file import read_fold
from solver.pattern.reading import read_pattern

ROOT = Path(__file__).resolve().parents[3]

#: A square of 4 with a vertical line at x = 2, cut in two by a horizontal one.
CROSS_POINTS = [[0, 0], [2, 0], [4, 0], [4, 2], [4, 4], [2, 4], [0, 4], [0, 2], [2, 2]]
CROSS_BORDER = [[k, (k + 1) % 8] for k in range(8)]
CROSS_INNER = [[1, 8], [8, 5], [7, 8], [8, 3]]
CROSS_FACES = [[0, 1, 8, 7], [1, 2, 3, 8], [8, 3, 4, 5], [7, 8, 5, 6]]


def cross(letters: str = "VVMM", **more: Any) -> dict[str, Any]:
    """The square with its cross; ``more`` changes it, None takes a key away."""
    content = {
        "file_spec": 1.2,
        "frame_classes": ["creasePattern"],
        "vertices_coords": CROSS_POINTS,
        "edges_vertices": [*CROSS_BORDER, *CROSS_INNER],
        "edges_assignment": [*"BBBBBBBB", *letters],
        **more,
    }
    return {key: value for key, value in content.items() if value is not None}


def drawing(lines: Sequence[tuple[str, Any]], **more: Any) -> dict[str, Any]:
    """Polylines with letters on a square of 10, as a file whose vertices are all listed anew for each line."""
    square = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)]
    points: list[list[float]] = []
    edges, letters = [], []
    for letter, line in [("B", square), *lines]:
        for a, b in itertools.pairwise(line):
            edges.append([len(points), len(points) + 1])
            points += [list(map(float, a)), list(map(float, b))]
            letters.append(letter)
    return {"vertices_coords": points, "edges_vertices": edges, "edges_assignment": letters, **more}


def read(content: Any) -> CreasePattern:
    return read_fold(io.StringIO(content if isinstance(content, str) else json.dumps(content)))[0]


def letters(pattern: CreasePattern) -> str:
    return "".join(crease.assignment for crease in pattern.creases)


def note(pattern: CreasePattern, *words: str) -> bool:
    return any(all(word in line for word in words) for line in pattern.notes)


def paper(pattern: CreasePattern) -> shapely.Polygon:
    return shapely.Polygon(pattern.boundary, pattern.holes)


def lengths(pattern: CreasePattern) -> list[float]:
    rows = [np.vstack([c.points, c.points[:1]]) if c.closed else c.points for c in pattern.creases]
    return [float(np.hypot(*np.diff(row, axis=0).T).sum()) for row in rows]


# ---- the plain file


def test_a_cross_on_a_square() -> None:
    pattern = read(cross(frame_unit="cm"))
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert len(pattern.boundary) == 4  # what lies on a straight side is no corner
    assert letters(pattern) == "VM"
    assert [crease.name for crease in pattern.creases] == ["valley 1", "mountain 1"]
    assert [crease.points.tolist() for crease in pattern.creases] == [[[2, 0], [2, 4]], [[0, 2], [4, 2]]]
    assert pattern.unit_mm == 10.0
    assert note(pattern, "1 stroke of edges marked V: valley crease (edges_assignment)")
    assert note(pattern, "1 stroke of edges marked M: mountain crease (edges_assignment)")


@pytest.mark.parametrize(
    ("unit", "unit_mm"),
    [
        ("mm", 1.0),
        ("m", 1000.0),
        ("in", 25.4),
        ("pt", 25.4 / 72),
        ("um", 1e-3),
        ("nm", 1e-6),
        ("unit", None),
        ("furlong", None),
        (3, None),
        (None, None),
    ],
)
def test_units(unit: Any, unit_mm: float | None) -> None:
    points = (10 * np.array(CROSS_POINTS)).tolist()
    assert read(cross(frame_unit=unit, vertices_coords=points)).unit_mm == unit_mm


def test_a_square_of_one_unit_is_no_millimetre() -> None:
    points = (np.array(CROSS_POINTS) / 4).tolist()
    pattern = read(cross(frame_unit="unit", vertices_coords=points))
    assert pattern.unit_mm == 100.0
    assert note(pattern, "no unit", "100 mm")
    assert read(cross(frame_unit="mm", vertices_coords=points)).unit_mm == 1.0


def test_a_line_goes_on_only_with_the_same_letter() -> None:
    assert letters(read(cross("VMUU"))) == "VMU"
    assert read(cross("VMUU")).creases[2].name == ""


def test_y_is_up_and_the_place_stays() -> None:
    points = (np.array(CROSS_POINTS) * [1.0, 2.0] + [100.0, 50.0]).tolist()
    assert paper(read(cross(vertices_coords=points))).bounds == (100.0, 50.0, 104.0, 58.0)


def test_bytes_of_every_encoding() -> None:
    text = json.dumps(cross(frame_title="\u6298"), ensure_ascii=False)
    for data in (text.encode("utf-8"), b"\xef\xbb\xbf" + text.encode(), text.encode("utf-16")):
        assert letters(read_fold(io.BytesIO(data))[0]) == "VM"


# ---- letters


def test_letters_as_files_have_them() -> None:
    pattern = read(cross(edges_assignment=[*"bBBBBBBB", "v", "V", None, "X"]))
    assert letters(pattern) == "VU"
    assert note(pattern, "1 edge with an unknown assignment ('X')")
    assert note(pattern, "1 edge without an assignment")
    assert note(pattern, "small letters")


def test_angles_give_letters_that_are_missing_and_change_none_that_is_there() -> None:
    angles = [*[0] * 8, 30, 30, -30, -30]
    assert letters(read(cross("UUUU", edges_foldAngle=angles))) == "VM"
    assert letters(read(cross("UUUU", edges_foldAngles=angles))) == "VM"  # FOLD 1.0
    assert letters(read(cross("MMVV", edges_foldAngle=angles))) == "MV"
    assert letters(read(cross("UUUU", edges_foldAngle=[*[0] * 8, 30, None, float("nan"), "x"]))) == "VUU"
    assert letters(read(cross("UUUU", edges_foldAngle=[1, 2]))) == "UU"


def test_angles_alone_say_what_is_folded() -> None:
    angles = [*[None] * 8, 30, 30, 0, 0]
    pattern = read(cross(edges_assignment=None, edges_foldAngle=angles, faces_vertices=CROSS_FACES))
    assert letters(pattern) == "V"
    assert note(pattern, "2 edges left out: flat")


def test_flat_and_joined_edges_are_no_creases() -> None:
    pattern = read(cross("VVFJ"))
    assert letters(pattern) == "V"
    assert note(pattern, "2 edges left out", "lines of a mesh")


# ---- border and holes


@pytest.mark.parametrize("known", ["edges", "faces", "both"])
def test_a_border_that_nobody_marks(known: str) -> None:
    """By the faces, or else by the outline of all edges."""
    content = cross(edges_assignment=None)
    if known != "edges":
        content["faces_vertices"] = CROSS_FACES
    if known == "faces":
        del content["edges_vertices"]
    pattern = read(content)
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert letters(pattern) == "UU"
    assert sorted(lengths(pattern)) == pytest.approx([4.0, 4.0])
    assert note(pattern, "the border is")


def test_a_border_of_mesh_lines() -> None:
    pattern = read(cross(edges_assignment=[*"FFFFFFFF", *"VVMM"]))
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert letters(pattern) == "VM"


def test_faces_with_vertices_of_their_own() -> None:
    points = [CROSS_POINTS[k] for face in CROSS_FACES for k in face]
    faces = [[k, k + 1, k + 2, k + 3] for k in range(0, 16, 4)]
    pattern = read({"vertices_coords": points, "faces_vertices": faces})
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert letters(pattern) == "UU"


def test_a_border_that_is_cut_in_part() -> None:
    pattern = read(cross(edges_assignment=[*"BBCBBBBB", *"VVMM"]))
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert note(pattern, "1 stroke of edges marked C: border")


def test_a_closed_line_beside_the_creases_is_not_their_border() -> None:
    stamp = [[6, 0], [7, 0], [7, 1], [6, 1]]
    ring = [[9, 10], [10, 11], [11, 12], [12, 9]]
    content = cross(
        vertices_coords=[*CROSS_POINTS, *stamp],
        edges_vertices=[*CROSS_BORDER, *CROSS_INNER, *ring],
        edges_assignment=[*"UUUUUUUU", *"VVMM", *"BBBB"],
    )
    pattern = read(content)
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert letters(pattern) == "VM"


def test_holes_of_every_kind() -> None:
    ring = [(1, 1), (2, 1), (2, 2), (1, 2), (1, 1)]

    def moved(x: float, y: float, size: float = 1.0) -> list[tuple[float, float]]:
        return [(size * a + x, size * b + y) for a, b in ring]

    pattern = read(
        drawing(
            [
                ("B", moved(0, 0)),
                ("C", moved(5, 5)),
                ("C", [(4, 7), (5, 8)]),  # a slit
                ("B", moved(5.75, 5.75, 0.5)),  # in a hole
                ("M", [(6.2, 6.5), (6.8, 6.5)]),  # in a hole
                ("V", [(0, 4), (10, 4)]),
                ("M", [(20, 4), (30, 4)]),
            ]
        )
    )
    assert paper(pattern).area == pytest.approx(98.0)
    assert {shapely.Polygon(hole).bounds for hole in pattern.holes} == {(1, 1, 2, 2), (6, 6, 7, 7)}
    assert letters(pattern) == "V"
    assert note(pattern, "1 stroke of edges marked C: left out", "does not close")
    assert note(pattern, "1 stroke of edges marked B: left out: inside a hole")
    assert note(pattern, "1 stroke of edges marked M: left out: inside a hole")
    assert note(pattern, "1 stroke of edges marked M: left out: beside the sheet")


def test_a_hole_known_by_the_faces_alone() -> None:
    grid = [[x, y] for y in range(4) for x in range(4)]
    quads = [[k, k + 1, k + 5, k + 4] for k in (0, 1, 2, 4, 6, 8, 9, 10)]
    pattern = read({"vertices_coords": grid, "faces_vertices": quads})
    assert paper(pattern).area == pytest.approx(8.0)
    assert shapely.Polygon(pattern.holes[0]).bounds == (1, 1, 2, 2)


# ---- edges -> creases


def test_small_edges_fold_as_the_curve_they_came_from() -> None:
    t = np.linspace(0.0, np.pi, 13)
    arc = np.column_stack([5 + 5 * np.cos(t), 2 + 3 * np.sin(t)])
    pattern = read(drawing([("M", arc)]))
    (crease,) = pattern.creases
    assert np.allclose(crease.points, arc, atol=1e-12)
    # Between the points: the ellipse, far nearer than its chords, which miss it by 0.03.
    x, y = sample_crease(crease, 0.1).T
    assert np.abs(np.hypot((x - 5) / 5, (y - 2) / 3) - 1.0).max() < 1e-3


def test_a_closed_chain_is_a_closed_crease() -> None:
    t = np.linspace(0.0, 2 * np.pi, 25)
    (crease,) = read(drawing([("V", np.column_stack([5 + 2 * np.cos(t), 5 + 2 * np.sin(t)]))])).creases
    assert crease.closed
    assert len(crease.points) == 24


def test_circles_cut_by_rays_stay_circles() -> None:
    """Each vertex is a crossing; rays and circles go on through it, and none turns into the other."""
    t = np.linspace(0.0, 2 * np.pi, 25)
    way = np.column_stack([np.cos(t), np.sin(t)])
    rings = [("M", 5 + r * way) for r in (1, 2, 3)]
    rays = [("M", [5 + r * w for r in (1, 2, 3, 4)]) for w in way[:-1]]
    pattern = read(drawing([*rings, *rays]))
    assert sum(crease.closed for crease in pattern.creases) == 3
    assert len(pattern.creases) == 3 + 24


def test_lines_that_turn_at_a_vertex_end_there() -> None:
    """A vertex of a straight design: its angles are multiples of 22.5 degrees, and two ways go nearly on."""
    ways = np.radians([0.0, 45.0, 112.5, 247.5])
    lines = [("M", [(5, 5), (5 + 4 * np.cos(a), 5 + 4 * np.sin(a))]) for a in ways]
    assert len(read(drawing(lines)).creases) == 4


def test_two_of_a_letter_among_others_do_not_turn_into_each_other() -> None:
    assert letters(read(cross("MVMV"))) == "MVMV"


def test_a_line_that_two_others_could_go_on_in_takes_the_straighter() -> None:
    ends = [(10, 5), (0, 5), (0, 5 - 5 * np.tan(np.radians(10.0)))]
    pattern = read(drawing([("M", [(5, 5), end]) for end in ends]))
    assert sorted(lengths(pattern)) == pytest.approx([5 / np.cos(np.radians(10.0)), 10.0])


def test_corners_of_a_line_without_crossings_stay_in_it() -> None:
    (crease,) = read(drawing([("M", [(0, 5), (4, 5), (4, 8), (10, 8)])])).creases
    assert crease.points.tolist() == [[0, 5], [4, 5], [4, 8], [10, 8]]


def test_a_crease_that_bounces_at_the_border_is_two() -> None:
    edges = [*CROSS_BORDER, [7, 1], [1, 3]]
    assert len(read(cross("MM", edges_vertices=edges)).creases) == 2


def test_without_a_border_the_box_of_what_is_drawn_is_the_sheet() -> None:
    pattern = read(cross(edges_vertices=[*[[0, 0]] * 8, *CROSS_INNER]))
    assert paper(pattern).equals(shapely.box(0, 0, 4, 4))
    assert letters(pattern) == "VM"
    assert note(pattern, "no border is drawn", "box of what is drawn")


def test_a_sheet_without_creases_is_blank_paper() -> None:
    pattern = read(cross("FFFF"))
    assert pattern.creases == ()
    assert note(pattern, "blank paper")


def test_ends_that_all_but_meet_are_joined() -> None:
    pattern = read(drawing([("M", [(0, 5), (5, 5)]), ("M", [(5.0004, 5), (10, 5)])]))
    assert len(pattern.creases) == 1
    assert note(pattern, "joined")
    assert len(read(drawing([("M", [(0, 5), (5, 5)]), ("M", [(5.01, 5), (10, 5)])])).creases) == 2


def test_edges_given_twice_or_without_length() -> None:
    edges = [*CROSS_BORDER, *CROSS_INNER, [5, 8], [8, 8], [1, 2]]
    pattern = read(cross(edges_vertices=edges, edges_assignment=[*"BBBBBBBBVVMM", *"UMM"]))
    assert letters(pattern) == "VM"
    assert note(pattern, "3 edges were left out: given twice")


def test_creases_that_the_writer_numbers() -> None:
    """A number joins what letters do not say, and is cut where the side changes."""
    numbers = [*[None] * 8, 4, 4, 0, 0]
    pattern = read(cross("VUMM", **{"edges_curvefold:crease": numbers}))
    assert letters(pattern) == "MV"
    assert [crease.name for crease in pattern.creases] == ["", "crease 5"]
    pattern = read(cross("VMMM", **{"edges_curvefold:crease": numbers}))
    assert letters(pattern) == "MVM"
    assert [crease.name for crease in pattern.creases] == ["", "crease 5 part 1", "crease 5 part 2"]


def test_a_numbered_crease_turns_as_it_likes() -> None:
    """At a vertex where it meets another, and where it meets itself."""
    sharp, other = [(0, 5), (5, 5), (1, 8)], [(5, 0), (5, 5), (10, 5)]
    content = drawing([("M", sharp), ("M", other)])
    content["edges_curvefold:crease"] = [*[None] * 4, 0, 0, 1, 1]
    assert [crease.points.tolist() for crease in read(content).creases] == [
        list(map(list, sharp)),
        list(map(list, other)),
    ]
    loop = [(0, 5), (5, 5), (9, 7.3), (9, 9.5), (5, 9.5), (5, 5), (7.3, 1)]
    content = drawing([("M", loop)])
    content["edges_curvefold:crease"] = [*[None] * 4, *[0] * 6]
    (crease,) = read(content).creases
    assert np.allclose(crease.points, loop)


def test_a_closed_crease_that_changes_its_side_twice() -> None:
    t = np.linspace(0.0, 2 * np.pi, 25)
    content = drawing([("V", np.column_stack([5 + 2 * np.cos(t), 5 + 2 * np.sin(t)]))])
    content["edges_assignment"][4 + 5 : 4 + 15] = [*"MMUUM", *"MMMMM"]
    content["edges_curvefold:crease"] = [*[None] * 4, *[0] * 24]
    pattern = read(content)
    assert sorted((c.assignment, len(c.points)) for c in pattern.creases) == [("M", 11), ("V", 15)]
    assert sum(lengths(pattern)) == pytest.approx(24 * 4 * np.sin(np.pi / 24))


# ---- indices


def test_vertices_counted_from_one() -> None:
    edges = [[a + 1, b + 1] for a, b in [*CROSS_BORDER, *CROSS_INNER]]
    pattern = read(cross(edges_vertices=edges))
    assert letters(pattern) == "VM"
    assert note(pattern, "counted from 1")


def test_nulls_and_whole_floats() -> None:
    edges = [[float(a), b] for a, b in [*CROSS_BORDER, *CROSS_INNER]]
    pattern = read(
        cross(
            vertices_coords=[*CROSS_POINTS, None],
            edges_vertices=[*edges[:8], None, *edges[8:]],
            edges_assignment=[*"BBBBBBBB", "X", *"VVMM"],
            faces_vertices=[None],
        )
    )
    assert letters(pattern) == "VM"


# ---- frames

FOLDED = [[x, y, x * x] for x, y in CROSS_POINTS]


def test_a_frame_that_inherits_is_the_crease_pattern() -> None:
    flat = {
        "frame_classes": ["creasePattern"],
        "frame_title": "flat\nsheet",
        "frame_parent": 0,
        "frame_inherit": True,
        "vertices_coords": CROSS_POINTS,
    }
    folded = cross(frame_classes=["foldedForm"], vertices_coords=FOLDED, frame_unit="mm")
    pattern = read({**folded, "file_frames": [{"frame_classes": ["foldedForm"]}, flat]})
    assert letters(pattern) == "VM"
    assert pattern.unit_mm == 1.0
    assert note(pattern, "frame 3 of 3 (flat sheet)", "crease pattern")
    with pytest.raises(PatternError, match="neither edges_vertices nor faces_vertices"):
        read({**folded, "file_frames": [{**flat, "frame_inherit": False}]})


def test_a_frame_without_classes_is_read_when_it_is_flat() -> None:
    first = cross(frame_classes=None, vertices_coords=FOLDED)
    second = {"frame_inherit": True, "frame_parent": 0, "vertices_coords": [[x, y, 7] for x, y in CROSS_POINTS]}
    assert paper(read({**first, "file_frames": [second]})).equals(shapely.box(0, 0, 4, 4))
    with pytest.raises(PatternError, match=r"vertices_coords\[\d\].*not flat"):
        read(first)


def test_a_crease_pattern_goes_before_a_frame_that_is_only_flat() -> None:
    first = {**cross("UUUU", frame_classes=None), "file_frames": [cross(), cross("MMVV")]}
    pattern = read(first)
    assert letters(pattern) == "VM"
    assert note(pattern, "frame 2 of 3")


@pytest.mark.parametrize(
    ("placed", "corner"),
    [(lambda x, y: (x, y, 3.0), (4, 1)), (lambda x, y: (x, 3.0, -y), (4, 1)), (lambda x, y: (3.0, x, y), (4, 1))],
    ids=["z", "y", "x"],
)
def test_flat_in_any_plane_of_two_axes(placed: Any, corner: tuple[float, float]) -> None:
    """Seen from the positive side: no mirror image, in which mountains would be valleys."""
    points = np.array(CROSS_POINTS, dtype=float)
    points[2] = corner
    pattern = read(cross(vertices_coords=[placed(x, y) for x, y in points.tolist()]))
    assert paper(pattern).equals(shapely.Polygon(points[:8]))


def test_a_folded_form_that_lies_open_is_a_crease_pattern() -> None:
    pattern = read(cross(frame_classes=["foldedForm"], faces_vertices=CROSS_FACES))
    assert letters(pattern) == "VM"
    assert note(pattern, "folded form lies flat")
    assert letters(read(cross(frame_classes=["foldedForm"]))) == "VM"


def test_a_folded_form_with_a_part_on_another_is_none() -> None:
    folded = [[min(x, 4 - x), y] for x, y in CROSS_POINTS]
    content = cross(frame_classes=["foldedForm"], vertices_coords=folded, faces_vertices=CROSS_FACES)
    with pytest.raises(PatternError, match="only a folded form"):
        read(content)


def test_a_corner_that_is_folded_in_is_no_crease_pattern() -> None:
    """No edge of it crosses another one, and the flap lies wholly on the face that it belongs to."""
    points = [[0, 0], [4, 0], [4, 4], [2, 4], [0, 2], [1.2, 2.8]]
    content = {
        "frame_classes": ["foldedForm"],
        "vertices_coords": points,
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0], [3, 5], [5, 4]],
        "edges_assignment": [*"BBBVBBB"],
        "faces_vertices": [[0, 1, 2, 3, 4], [4, 3, 5]],
    }
    with pytest.raises(PatternError, match="only a folded form"):
        read(content)


def test_a_face_amid_another_one_lies_open() -> None:
    points = [[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [3, 1], [2, 3]]
    content = {
        "frame_classes": ["foldedForm"],
        "vertices_coords": points,
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 4]],
        "edges_assignment": [*"BBBBMMM"],
        "faces_vertices": [[0, 1, 2, 3], [4, 5, 6]],
    }
    assert letters(read(content)) == "M"


def test_an_edge_that_is_mountain_and_valley_is_unassigned() -> None:
    edges = [*CROSS_BORDER, *CROSS_INNER, CROSS_INNER[0]]
    pattern = read(cross(edges_vertices=edges, edges_assignment=[*"BBBBBBBB", *"VVMM", "M"]))
    assert len(pattern.conflicts) == 1
    assert note(pattern, "as a mountain and as a valley", "unassigned")


def test_two_sheets_are_two_patterns() -> None:
    points = [[x + dx, y] for dx in (0, 6) for x, y in CROSS_POINTS]
    edges = [[a + k, b + k] for k in (0, 9) for a, b in (*CROSS_BORDER, *CROSS_INNER)]
    content = cross(vertices_coords=points, edges_vertices=edges, edges_assignment=[*"BBBBBBBBVVMM"] * 2)
    first, second = read_fold(io.StringIO(json.dumps(content)))
    assert paper(first).equals(shapely.box(0, 0, 4, 4))
    assert paper(second).equals(shapely.box(6, 0, 10, 4))
    assert letters(first) == letters(second) == "VM"
    assert not note(second, "of 2")


@pytest.mark.parametrize(
    ("parents", "words"),
    [([2, 1], "inherits from itself"), ([9, 0], "frame_parent"), (["0", True], "frame_parent")],
)
def test_frames_that_go_round(parents: list[Any], words: str) -> None:
    frames = [{"frame_inherit": True, "frame_parent": parent} for parent in parents]
    with pytest.raises(ReadError, match=words) as refused:
        read({"file_frames": frames})
    assert "file_frames[" in str(refused.value)


def test_a_chain_of_frames_is_followed_only_so_far() -> None:
    frames = [{"frame_inherit": True, "frame_parent": k} for k in range(200)]
    assert letters(read({**cross(), "file_frames": frames})) == "VM"
    frames[-1]["frame_parent"] = 198
    with pytest.raises(ReadError, match="more than 100 frames inherit"):
        read({"file_frames": frames})


# ---- what is refused

MANY = fold_file_frames.MAX_VALUES + 1
REFUSED: dict[str, tuple[Any, str]] = {
    "empty": (" \n", "the file is empty"),
    "no JSON": ('{"a": 1,\n]', "not JSON .* in line 2"),
    "no object": ("[1, 2]", "JSON but not a FOLD file"),
    "deep": ("[" * 100_000, "nested too deep|not JSON"),
    "many values": ("[" + "1," * MANY, "values"),
    "long number": ('{"vertices_coords": [[' + "1" * 5000 + "]]}", "not JSON|not two or three"),
    "nothing": ({}, "no line"),
    "frames": ({"file_frames": 3}, "file_frames: it is not a list"),
    "no points": (cross(vertices_coords=[]), "vertices_coords: it has no point"),
    "points": (cross(vertices_coords=7), "vertices_coords: it is not a list"),
    "point": (cross(vertices_coords=[[0, 0], [1]]), r"vertices_coords\[1\]: it is not two or three numbers"),
    "boolean point": (cross(vertices_coords=[[0, 0], [True, 0]]), r"vertices_coords\[1\]"),
    "text point": (cross(vertices_coords=[["0", "0"]]), r"vertices_coords\[0\]"),
    "NaN": (cross(vertices_coords=[[0, 0], [float("nan"), 0]]), r"vertices_coords\[1\]: .* not finite"),
    "infinite": (cross(vertices_coords=[[0, float("inf")]]), r"vertices_coords\[0\]: a coordinate is not finite"),
    "huge": (cross(vertices_coords=[[10**400, 0]]), r"vertices_coords\[0\]: a coordinate is not finite"),
    "one place": (cross(vertices_coords=[[5, 5]] * 9), "no size"),
    "null point": (cross(vertices_coords=[*CROSS_POINTS[:8], None]), r"edges_vertices\[8\]: .*without coordinates"),
    "edges": (cross(edges_vertices={"a": 1}), "edges_vertices: it is not a list"),
    "edge": (cross(edges_vertices=[[0, 1], [0, 1, 2]]), r"edges_vertices\[1\]: it is not a list of 2 vertices"),
    "far vertex": (cross(edges_vertices=[[0, 1], [1, 99]]), r"edges_vertices\[1\]: vertex 99 does not exist"),
    "huge vertex": (cross(edges_vertices=[[0, 10**30]]), r"edges_vertices\[0\]: .*whole number"),
    "negative vertex": (cross(edges_vertices=[[0, 1], [0, -1]]), r"edges_vertices\[1\]: vertex -1 does not exist"),
    "half vertex": (cross(edges_vertices=[[0, 1], [0, 1.5]]), r"edges_vertices\[1\]: .*whole number"),
    "true vertex": (cross(edges_vertices=[[0, 1], [0, True]]), r"edges_vertices\[1\]: .*whole number"),
    "face": (cross(faces_vertices=[[0, 1, 8], [0, 1]]), r"faces_vertices\[1\]: .*3 or more"),
    "far face": (cross(faces_vertices=[[0, 1, 8], None, [0, 1, 77]]), r"faces_vertices\[2\]: vertex 77"),
    "letters": (cross(edges_assignment="BBBB"), "edges_assignment: it is not a list"),
    "open": (cross(edges_vertices=[*CROSS_BORDER[:6], [0, 0], [7, 0], *CROSS_INNER]), "does not close: .* by 2"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_drawing_is_refused_in_one_sentence(name: str, tmp_path: Path) -> None:
    content, words = REFUSED[name]
    path = tmp_path / "bad.fold"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises(CurvefoldError, match=words) as refused:
        read_pattern(path)
    assert isinstance(refused.value, ReadError | PatternError)
    assert refused.value.where.file == str(path)
    assert len(str(refused.value).splitlines()) == 1


def test_a_missing_file_names_itself(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"none\.fold.*cannot be read"):
        read_pattern(tmp_path / "none.fold")


def test_large_drawings_are_read_or_refused() -> None:
    """As many edges as an SVG may have points; thousands may meet at one vertex."""
    t = np.linspace(0.0, 2 * np.pi, 150_000, endpoint=False)
    points = [[5, 5], *(5 + 4 * np.column_stack([np.cos(t), np.sin(t)])).tolist()]
    star = [[0, k + 1] for k in range(0, len(t), 6)]
    with pytest.raises(PatternError, match="too many lines"):
        read({"vertices_coords": points, "edges_vertices": star})
    ring = [[k + 1, (k + 1) % len(t) + 1] for k in range(len(t))]
    pattern = read({**drawing([]), **_added(drawing([]), points, ring)})
    assert [len(crease.points) for crease in pattern.creases] == [150_000]
    twice = [[a, (b + 1) % len(t) + 1] for a, b in star]
    with pytest.raises(PatternError, match="more than 200,000 points"):
        read({**drawing([]), **_added(drawing([]), points, [*ring, *star, *twice, [0, 4]])})


def _added(content: dict[str, Any], points: list[Any], edges: list[Any]) -> dict[str, Any]:
    """``content`` with more valleys."""
    first = len(content["vertices_coords"])
    return {
        "vertices_coords": [*content["vertices_coords"], *points],
        "edges_vertices": [*content["edges_vertices"], *([a + first, b + first] for a, b in edges)],
        "edges_assignment": [*content["edges_assignment"], *["V"] * len(edges)],
    }


# ---- our own files


@pytest.mark.parametrize("name", ["annulus", "circle_in_square", "crossing", "miura", "waves"])
def test_what_we_write_we_read(name: str, tmp_path: Path) -> None:
    drawn = read_pattern(ROOT / "sample_patterns" / f"{name}.svg")
    result = solver.fold(drawn, solver.FoldDescription(resolution=14, angle=40.0))
    solver.write_results(result, tmp_path)
    again = read_pattern(tmp_path / "folded.fold")
    size = float(np.ptp(drawn.boundary, axis=0).max())
    assert again.unit_mm == pytest.approx(drawn.unit_mm)
    assert paper(again).area == pytest.approx(paper(drawn).area, rel=3e-4)
    # Curves are as fine as the mesh: chords of at most a cell, on a border of a radius of half a sheet or less.
    sagitta = (size / 14) ** 2 / 8 / (0.15 * size)
    assert shapely.hausdorff_distance(paper(again).boundary, paper(drawn).boundary) < sagitta
    assert len({_whole(again, k) for k in range(len(again.creases))}) == len(drawn.creases)
    for k, crease in enumerate(again.creases):
        number = _whole(again, k)
        line = shapely.LineString(sample_crease(drawn.creases[number], size / 500))
        assert crease.closed == drawn.creases[number].closed
        # The spline through the mesh's points, not their chords, is the curve that was drawn.
        places = shapely.points(sample_crease(crease, size / 500))
        assert shapely.distance(places, line).max() < 2e-4 * size
        _check_letters(result, number, crease, size)
    assert sum(lengths(again)) == pytest.approx(sum(lengths(drawn)), rel=1e-3)


def _whole(pattern: CreasePattern, index: int) -> int:
    """Which crease of the folded drawing this is."""
    name = pattern.creases[index].name
    return int(name.split()[1]) - 1 if name else index


def _check_letters(result: solver.FoldResult, number: int, crease: solver.Crease, size: float) -> None:
    """Every measured point of the fold that lies on the crease is folded to its side."""
    points = result.net.crease_points
    row = np.vstack([crease.points, crease.points[:1]]) if crease.closed else crease.points
    flat = shapely.points(result.net.frame.to_drawing(points.position))
    near = shapely.distance(shapely.LineString(row), flat) < 1e-3 * size
    mine = np.flatnonzero((points.crease == number) & near & (result.measurement.fold_angle > 5.0))
    assert len(mine)
    expected = {"V": 1, "M": -1}[crease.assignment]
    assert (np.sign(result.measurement.fold_sign[mine]) == expected).mean() > 0.9


def test_a_miura_folds_by_the_command(tmp_path: Path) -> None:
    columns, rows = 5, 5
    points = [[x, y + 0.4 * (x % 2)] for y in range(rows) for x in range(columns)]
    edges, marks = [], []
    for y in range(rows):
        for x in range(columns):
            k = y * columns + x
            if x + 1 < columns:
                edges.append([k, k + 1])
                marks.append("B" if y in (0, rows - 1) else "MV"[y % 2])
            if y + 1 < rows:
                edges.append([k, k + columns])
                marks.append("B" if x in (0, columns - 1) else "MV"[(x + y) % 2])
    path = tmp_path / "miura.fold"
    path.write_text(json.dumps({"vertices_coords": points, "edges_vertices": edges, "edges_assignment": marks}))
    said = io.StringIO()
    out = tmp_path / "out"
    # Whether all its creases can have one angle is the paper's business: those of a Miura differ.
    assert main(["fold", str(path), "--out", str(out), "--resolution", "16", "--angle", "50"], said) in (0, 1)
    report = json.loads((out / "report.json").read_text())
    assert report["folded"] == 1.0
    assert report["fold_angle"][1] > 30
    assert "and 12 more" in said.getvalue()


def test_a_result_is_not_written_over_its_drawing(tmp_path: Path) -> None:
    path = tmp_path / "folded.fold"
    path.write_text(json.dumps(cross()))
    before, said = path.read_bytes(), io.StringIO()
    assert main(["fold", str(path), "--out", str(tmp_path)], said) == 2
    assert "over it" in said.getvalue()
    assert path.read_bytes() == before


# ---- folded forms of many faces and frames


def stack(offsets: Sequence[float]) -> dict[str, Any]:
    """Unit squares beside each other, each at its offset along x; called folded."""
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    points = [[x + dx, y] for dx in offsets for x, y in corners]
    faces = [[4 * k + j for j in range(4)] for k in range(len(offsets))]
    return {"frame_classes": ["foldedForm"], "vertices_coords": points, "faces_vertices": faces}


def test_one_face_of_many_that_lies_on_another_makes_a_folded_form_of_it() -> None:
    count = 3 * fold_file_frames._AT_ONCE
    beside = [float(k) for k in range(count)]
    assert len(read(stack(beside)).boundary) >= 4
    with pytest.raises(PatternError, match="only a folded form"):
        read(stack([*beside, count - 0.5]))


def test_frames_that_inherit_the_same_folded_form_are_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[int] = []
    lies_open = fold_file_frames._lies_open
    monkeypatch.setattr(
        fold_file_frames,
        "_lies_open",
        lambda file, index, flat: looked.append(index) or lies_open(file, index, flat),
    )
    heirs = [{"frame_inherit": True, "frame_parent": 0} for _ in range(50)]
    with pytest.raises(PatternError, match="only a folded form"):
        read({**stack([0.0, 0.5]), "file_frames": heirs})
    assert looked == [0]


def test_lines_of_a_mesh_that_are_too_many_are_left_out_with_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a border they are candidates for it, as long as there are not too many."""
    content = cross("VVMM", edges_assignment=[*"UUUUUUUU", *"VVFF"], faces_vertices=None)
    assert not any("lines of a mesh" in note for note in read(content).notes)
    monkeypatch.setattr(fold_file_strokes, "MAX_STROKES", 3)
    assert any("2 edges left out: flat or joined, lines of a mesh" in note for note in read(content).notes)
