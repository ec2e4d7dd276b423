"""An independent check of any mesh with its flat sheet: whether it is paper, whoever made it.

    verification = solver.verify_mesh(solver.read_mesh("folded.obj"))
    verification.ok, verification.faults

The net that folded a sheet knows more (``verify``); a mesh from a file, cut, moved or baked has only this.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .arrays import FloatArray, IntArray
from .sheet_mesh import SheetMesh
from .verify import LEAST_AREA, MAX_MEAN_STRETCH, MAX_STRETCH, MOST_AREA, Fault, Verification

#: A mesh has chords where the sheet is curved, which are shorter than the paper between their ends: its lengths may
#: change by so much more in the mean than a net's.
CHORDS = 0.002
#: Angles around an inner vertex add up to the flat ones, degrees: in the mean over the sheet. The samples miss that
#: by 0.7 at 24 quads and by 1.1 at 12; a sheet crumpled so finely that its lengths do not show it, by 2.
MAX_MEAN_DEFECT = 1.5
#: Vertices at one place of the flat sheet are no farther apart than this, mean edges.
MAX_CRACK = 2e-2
#: Edges shorter than a crack may be have no direction, mean edges: for angles their ends are one vertex.
_NO_DIRECTION = MAX_CRACK
#: Faces smaller than this part of the mean one say nothing about areas: one rounded coordinate turns them.
_SMALL_FACE = 0.02
#: Edges shorter than this part of the mean one say nothing about the scale.
_SMALL_EDGE = 0.02
#: Corners nearer to each other than this on the flat sheet are one place, mean edges; and of how many others there.
_SAME_PLACE, _AT_ONE_PLACE = 1e-4, 8
#: Coordinates beyond this are at no place, and lengths below its inverse are none: what is computed stays finite.
_NOWHERE = 1e30


def verify_mesh(mesh: SheetMesh) -> Verification:
    """Check a folded mesh against its flat sheet; places of faults are on that sheet, in its units.

    Without a scale of its own the mesh is taken in the scale that fits most edges, so that only uneven stretch
    shows. ``figures["pieces"]``: parts of the sheet that do not hang together. Whether creases are folded is not
    asked (``verify`` tells, with the net): a crease that is bent through is paper too.
    """
    check = _MeshCheck(mesh)
    if not check.finite():
        return check.done()
    if check.normalise():
        check.lengths()
        check.faces()
        check.cracks()
        node = _nodes(check.mesh)
        check.figures["pieces"] = float(_pieces(check.mesh, node))
        check.angles(_welded(check.mesh, node))
    return check.done()


def verdict(found: Verification) -> str:
    """What ``verify_mesh`` found, as the end of a sentence: "paper: …" with the figures, or "not paper: …"."""
    if not found.ok:
        more = len(found.faults) - 1
        also = f"; and {_count(more, 'more fault', 'more faults')}" if more else ""
        return f"not paper: {found.faults[0]}{also}"
    figures = found.figures
    mean, most = (max(figures[f"{name}_{kind}"] for name in ("stretch", "shear")) for kind in ("mean", "max"))
    pieces = int(figures["pieces"])
    apart = f", in {pieces} pieces" if pieces > 1 else ""
    return (
        f"paper: lengths change by {mean:.2%} in the mean and {most:.1%} at most, "
        f"angles around a vertex by {figures['angle_defect_mean']:.2f}°{apart}"
    )


class _MeshCheck:
    """Gathers figures and faults. mesh: in mean flat edges, once it is normalised; places (L,2): as given."""

    def __init__(self, mesh: SheetMesh) -> None:
        self.mesh = mesh
        self.places = mesh.corner_flat
        self.figures: dict[str, float] = {}
        self.faults: list[Fault] = []

    def done(self) -> Verification:
        return Verification(self.figures, tuple(self.faults))

    def fault(self, check: str, sentence: str, corner: int | None, at: str = "at") -> None:
        if corner is None:
            self.faults.append(Fault(check, sentence, None))
            return
        x, y = self.places[corner].tolist()
        self.faults.append(Fault(check, f"{sentence}, {at} ({x:.6g}, {y:.6g})", (x, y)))

    # --- before anything can be measured ---------------------------------------------------------------

    def finite(self) -> bool:
        """Whether every corner is at a place, in space and on the sheet."""
        mesh = self.mesh
        there = (np.abs(mesh.vertices) < _NOWHERE).all(axis=1)[mesh.face_vertices]
        known = (np.abs(mesh.corner_flat) < _NOWHERE).all(axis=1)
        if not there.all():
            lost = len(np.unique(mesh.face_vertices[~there]))
            self.fault("finite", f"{_count(lost, 'vertex is', 'vertices are')} not at a finite place",
                       int(np.argmin(there)) if known[np.argmin(there)] else None)  # fmt: skip
        if not known.all():
            lost = int((~known).sum())
            self.fault("finite", f"{_count(lost, 'corner is', 'corners are')} nowhere on the flat sheet", None)
        return not self.faults

    def normalise(self) -> bool:
        """Lengths in mean flat edges, the sheet in its own scale; whether there is anything to measure."""
        mesh = self.mesh
        # From a corner of it: a sheet far from the origin loses no digits.
        flat = mesh.corner_flat - mesh.corner_flat[0]
        x = mesh.vertices - mesh.vertices[mesh.face_vertices[0]]
        length = np.hypot(*(flat[mesh.next] - flat).T)
        unit = float(length.mean())
        if not unit > 1.0 / _NOWHERE:
            self.fault("flat", "the flat sheet is a single point", None)
            return False
        scale = mesh.scale
        if scale is None:
            some = length > _SMALL_EDGE * unit
            across = np.linalg.norm(x[mesh.face_vertices[mesh.next]] - x[mesh.face_vertices], axis=1)
            scale = float(np.median(across[some] / length[some]))
        if not scale * unit > 1.0 / _NOWHERE:
            self.fault("isometry", "most of the sheet is a single point in space", None)
            return False
        self.figures["scale"] = scale
        self.mesh = replace(mesh, vertices=x / (scale * unit), corner_flat=flat / unit)
        return True

    # --- the checks ------------------------------------------------------------------------------------

    def lengths(self) -> None:
        """Isometric: no edge much longer or shorter than on the flat sheet, and no diagonal of a face."""
        mesh = self.mesh
        x, flat = mesh.vertices[mesh.face_vertices], mesh.corner_flat
        # Edges alone would pass a sheared sheet: a fishnet takes the shape of a ball.
        for end, thing, name in ((mesh.next, "an edge", "stretch"), (mesh.next[mesh.next], "a face", "shear")):
            length = np.hypot(*(flat[end] - flat).T)
            change = np.abs(np.linalg.norm(x[end] - x, axis=1) - length)
            mean = float(change.sum() / length.sum())
            self.figures[f"{name}_mean"] = mean
            bound = MAX_MEAN_STRETCH + CHORDS
            if not mean <= bound:
                many = "edges are stretched" if name == "stretch" else "faces are stretched from corner to corner"
                self.fault("isometry", f"{many} by {mean:.2%} in the mean, over {bound:.1%}", None)
            # A short edge may miss by more than its length: what counts is the miss beside a usual edge.
            excess = change / np.maximum(length, 1.0)
            worst = int(np.argmax(excess))
            self.figures[f"{name}_max"] = float(excess[worst])
            if not excess[worst] <= MAX_STRETCH:
                sentence = f"{thing} is stretched by {excess[worst]:.1%}, over {MAX_STRETCH:.0%}"
                self.fault("isometry", sentence, worst)

    def faces(self) -> None:
        """No face is flipped on the flat sheet, grown or gone."""
        mesh = self.mesh
        flat = _area_vectors(_upright(mesh.corner_flat), mesh)[:, 2]
        area = np.linalg.norm(_area_vectors(mesh.vertices[mesh.face_vertices], mesh), axis=1)
        usual = float(np.abs(flat).mean())
        if not usual > 0.0:
            self.fault("faces", "the flat sheet is a single line", None)
            return
        large = np.abs(flat) > _SMALL_FACE * usual
        flipped = large & (np.sign(flat) != np.sign(flat.sum()))
        self.figures["flipped"] = float(flipped.sum())
        if flipped.any():
            lie = _count(int(flipped.sum()), "face lies", "faces lie")
            first = int(mesh.face_start[np.argmax(flipped)])
            self.fault("faces", f"{lie} upside down on the flat sheet", first)
        part = np.where(large, area / np.where(large, np.abs(flat), 1.0), 1.0)
        least, most = int(np.argmin(part)), int(np.argmax(part))
        self.figures["area_min"], self.figures["area_max"] = float(part[least]), float(part[most])
        if not part[least] >= LEAST_AREA:
            sentence = f"a face has only {part[least]:.0%} of its flat area, under {LEAST_AREA:.0%}"
            self.fault("faces", sentence, int(mesh.face_start[least]))
        if not part[most] <= MOST_AREA:
            sentence = f"a face has {part[most]:.2f} times its flat area, over {MOST_AREA:g}"
            self.fault("faces", sentence, int(mesh.face_start[most]))

    def cracks(self) -> None:
        """One place of the flat sheet is one place in space."""
        mesh = self.mesh
        # Each vertex once at each of its places; its corners there differ by rounding at most.
        _, one = np.unique(np.column_stack([mesh.face_vertices, np.round(mesh.corner_flat / _SAME_PLACE)]),
                           axis=0, return_index=True)  # fmt: skip
        flat, vertex = mesh.corner_flat[one], mesh.face_vertices[one]
        near = min(_AT_ONE_PLACE, len(one))
        _, other = cKDTree(flat).query(flat, k=near, distance_upper_bound=_SAME_PLACE)
        first, second = np.repeat(np.arange(len(one)), near), other.reshape(-1)
        found = second < len(one)
        first, second = first[found], second[found]
        gap = np.linalg.norm(mesh.vertices[vertex[first]] - mesh.vertices[vertex[second]], axis=1)
        worst = int(np.argmax(gap))
        self.figures["crack_max"] = float(gap[worst])
        if not gap[worst] <= MAX_CRACK:
            sentence = f"the sheet is torn: two vertices of one place are {gap[worst]:.2g} mean edges apart"
            self.fault("continuity", sentence, int(one[first[worst]]))

    def angles(self, sheet: _Sheet | None) -> None:
        """Developable: around an inner vertex angles add up to what they do on the flat sheet."""
        self.figures["angle_defect_mean"] = 0.0
        if sheet is None:
            return
        mesh = sheet.mesh
        size = len(mesh.vertices)
        flat = _upright(mesh.corner_flat)
        gain = _corner_angles(mesh.vertices[mesh.face_vertices], mesh) - _corner_angles(flat, mesh)
        miss = np.degrees(np.abs(np.bincount(mesh.face_vertices, gain, minlength=size)))
        part = np.linalg.norm(_area_vectors(flat, mesh), axis=1) / np.diff(mesh.face_start)
        share = np.bincount(mesh.face_vertices, part[mesh.face], minlength=size)
        share[_rim(mesh)] = 0.0
        total = float(share.sum())
        mean = float((miss * share).sum()) / total if total > 0.0 else 0.0
        self.figures["angle_defect_mean"] = mean
        if not mean <= MAX_MEAN_DEFECT:
            worst = int(np.flatnonzero(mesh.face_vertices == np.argmax(miss * share))[0])
            sentence = (
                f"angles around a vertex miss their flat sum by {mean:.2f}° in the mean, over {MAX_MEAN_DEFECT:g}°"
            )
            self.fault("angles", sentence, int(sheet.corner[worst]), "worst at")


@dataclass(frozen=True, eq=False)
class _Sheet:
    """A mesh as it hangs together on the flat sheet: where that is cut, vertices are apart; no edge is very short.

    corner (L,): of the mesh that it is made from
    """

    mesh: SheetMesh
    corner: IntArray


def _nodes(mesh: SheetMesh) -> IntArray:
    """(L,) one number for the corners that are one vertex of the flat sheet: where it is cut, there are several."""
    flat, after = mesh.corner_flat, mesh.next
    # Where two faces share an edge in space, do they on the flat sheet? Each end of it has a corner in both.
    order = np.argsort(mesh.edge, kind="stable")
    same = np.flatnonzero(mesh.edge[order][1:] == mesh.edge[order][:-1])
    one, other = order[same], order[same + 1]
    along = mesh.face_vertices[one] == mesh.face_vertices[other]
    first = np.concatenate([one, after[one]])
    second = np.concatenate([np.where(along, other, after[other]), np.where(along, after[other], other)])
    near = np.hypot(*(flat[first] - flat[second]).T) < _SAME_PLACE
    return _connected(first[near], second[near], len(flat))


def _pieces(mesh: SheetMesh, node: IntArray) -> int:
    """How many parts of the flat sheet do not hang together."""
    faces = len(mesh.face_start) - 1
    return int(_connected(mesh.face, faces + node, faces + int(node.max()) + 1).max()) + 1


def _welded(mesh: SheetMesh, node: IntArray) -> _Sheet | None:
    """The sheet without edges that have no direction, their ends one vertex; None when no face is left.

    mesh: in mean flat edges; node (L,) from ``_nodes``
    """
    short = np.hypot(*(mesh.corner_flat[mesh.next] - mesh.corner_flat).T) < _NO_DIRECTION
    count = int(node.max()) + 1
    label = _connected(node[short], node[mesh.next[short]], count)[node]
    stays = label != label[mesh.next]
    stays &= np.bincount(mesh.face, stays)[mesh.face] >= 3
    if not stays.any():
        return None
    corner = np.flatnonzero(stays)
    sizes = np.bincount(mesh.face[corner])
    start = np.concatenate([[0], np.cumsum(sizes[sizes > 0])])
    _, member = np.unique(label, return_index=True)
    whole = SheetMesh(
        mesh.vertices[mesh.face_vertices[member]], start, label[corner], mesh.corner_flat[member][label[corner]]
    )
    return _Sheet(whole, corner)


def _connected(first: IntArray, second: IntArray, count: int) -> IntArray:
    """(count,) a number for all that hang together by the pairs (first, second)."""
    graph = coo_matrix((np.ones(len(first), dtype=bool), (first, second)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _rim(mesh: SheetMesh) -> IntArray:
    """Vertices of edges that do not have two faces."""
    _, edge, uses = np.unique(mesh.edge, return_inverse=True, return_counts=True)
    lonely = uses[edge] != 2
    return np.unique(np.concatenate([mesh.face_vertices[lonely], mesh.face_vertices[mesh.next[lonely]]]))


def _area_vectors(points: FloatArray, mesh: SheetMesh) -> FloatArray:
    """(F,3) normals of the faces as long as their areas; points (L,3) of the corners."""
    # From a corner of each face: numbers stay small.
    arm = points - points[mesh.face_start[mesh.face]]
    return 0.5 * np.add.reduceat(np.cross(arm, arm[mesh.next]), mesh.face_start[:-1], axis=0)


def _upright(flat: FloatArray) -> FloatArray:
    """(L,3) points of the flat sheet (L,2), in space."""
    return np.column_stack([flat, np.zeros(len(flat))])


def _corner_angles(points: FloatArray, mesh: SheetMesh) -> FloatArray:
    """(L,) angle of the face at each corner, 0 to pi; points (L,3)."""
    arm, other = points[mesh.next] - points, points[mesh.previous] - points
    return np.arctan2(np.linalg.norm(np.cross(arm, other), axis=1), (arm * other).sum(axis=1))


def _count(number: int, one: str, many: str) -> str:
    """ "1 face lies", "3 faces lie"."""
    return f"{number} {one if number == 1 else many}"
