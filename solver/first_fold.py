"""How a flat sheet starts to fold: a side for every crease, and the small normal offset that leads there.

Nothing in a flat sheet prefers mountain or valley, and the drive asks for neither. A random offset lets each
stretch of a crease choose for itself, and where choices meet the paper is stuck. Instead:
- sides are chosen so that every patch can bend one way. A crease of flat curvature k folded to a valley bends
  the patch on its left one way and the patch on its right the other (the osculating plane bisects the tangent
  planes), so creases around one patch should agree; and at an inner crease vertex of four or more arms at least
  three fold one way and at least one the other (a spherical polygon of perimeter 2 pi);
- the offset is the softest bending of the flat sheet with these sides.
Both depend on the drawing's geometry alone: a turned, moved, scaled or mirrored drawing starts likewise. Where the
drawing carries mountains and valleys that paper can have, they come first, and the other creases fit them.
It is only a start: the fold goes where the energy leads it, and other sides can win.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu
from shapely import Point

from .arrays import BoolArray, FloatArray, IntArray
from .controls.side import SIGNS
from .net.piecewise_dog import PiecewiseDog
from .objectives.bending import bending
from .objectives.continuity import continuity
from .objectives.fold_angle import driven_points

#: Up to this many free chains all choices are tried; sides of more are annealed.
_ENUMERATED = 14
#: Annealing: from the first to the last temperature, in costs, in so many sweeps over all chains, so many times.
_HOT, _COLD, _SWEEPS, _ANNEALINGS = 8.0, 0.02, 60, 3
#: Cost of a crease vertex whose arms cannot close, against agreements between creases, which are scaled to 1.
_VERTEX_COST = 10.0
#: Vertices with more arms are left to the fold; arms within this of a straight line are one, radians.
_MAX_ARMS, _STRAIGHT = 10, np.radians(3.0)
#: Weights of the offset's linear problem: kept folds and closed gaps against bending, and a bound on the rest.
_FOLD_WEIGHT, _GAP_WEIGHT, _REST_WEIGHT = 1.0, 1e4, 1e-8
#: Sums over handles below this say nothing about a way to bend.
_NO_WAY = 1e-9
#: Crease points coupled at once; longer creases are thinned.
_MAX_COUPLED = 1500


def choose_sides(net: PiecewiseDog, bound: Mapping[int, int] | None = None) -> IntArray:
    """+1 valley or -1 mountain for each chain (n,).

    bound: sides of creases (by index) that are given. Sides that are drawn are taken where both letters occur and
    no more crease vertices suffer by them than by a free choice. Without either, the first chain is a valley.
    """
    coupling = _couplings(net, len(net.chain_crease))
    arms = _inner_vertices(net)
    given = np.array([(bound or {}).get(int(crease), 0) for crease in net.chain_crease], dtype=np.int64)
    free = _chosen(given, coupling, arms)
    drawn = np.array([SIGNS.get(net.crease_letters[int(crease)], 0) for crease in net.chain_crease], dtype=np.int64)
    if not ((drawn > 0).any() and (drawn < 0).any()):
        return free
    fitting = _chosen(np.where(given == 0, drawn, given), coupling, arms)
    return fitting if _unfoldable(fitting, arms) <= _unfoldable(free, arms) else free


def _chosen(given: IntArray, coupling: FloatArray, arms: list[tuple[IntArray, BoolArray]]) -> IntArray:
    """The sides (n,) of least cost among those that have the given ones (n,), 0 where there is none."""
    given = given.copy()
    if not given.any():
        given[:1] = 1
    free = np.flatnonzero(given == 0)
    if len(free) <= _ENUMERATED:
        codes = np.arange(1 << len(free))
        sides = np.repeat(given[None], len(codes), axis=0)
        sides[:, free] = 1 - 2 * ((codes[:, None] >> np.arange(len(free))[None]) & 1)
        return np.asarray(sides[int(np.argmin(_cost(sides, coupling, arms)))])
    return _annealed(_spread(coupling, given), free, coupling, arms)


def _unfoldable(sides: IntArray, arms: list[tuple[IntArray, BoolArray]]) -> int:
    """How many crease vertices cannot fold with these sides (n,)."""
    return sum(not foldable[_code(sides[chains])] for chains, foldable in arms)


def _code(sides: IntArray) -> int:
    """The sides (d,) of a vertex's arms as a number: bit k is set where arm k is a mountain."""
    return int(((sides < 0) << np.arange(len(sides))).sum())


def first_fold(net: PiecewiseDog, sides: IntArray) -> FloatArray:
    """(V,) normal offsets whose folds are about ``sides`` (chains,) radians: scale it to taste."""
    points = net.crease_points
    chosen = driven_points(net)
    left, right = points.left_edge[chosen], points.right_edge[chosen]
    step = net.flat[left[:, 1]] - net.flat[left[:, 0]]
    length = np.hypot(*step.T)
    length_right = np.hypot(*(net.flat[right[:, 1]] - net.flat[right[:, 0]]).T)
    tangent = points.tangent[chosen]
    # Slope difference across a valley of 1 radian, seen along the grid edge: sine of its angle to the crease.
    lean = (tangent[:, 0] * step[:, 1] - tangent[:, 1] * step[:, 0]) / length
    n, size = len(chosen), len(net.flat)
    rows = np.repeat(np.arange(n), 4)
    values = np.column_stack([-1 / length, 1 / length, 1 / length_right, -1 / length_right])
    fold = csr_matrix((values.ravel(), (rows, np.hstack([left, right]).ravel())), shape=(n, size))
    matrix = _FOLD_WEIGHT * (fold.T @ fold) + _REST_WEIGHT * diags(np.ones(size))
    for term, weight in (*((b, 1.0) for b in bending(net, 1.0)), (continuity(net, 1.0), _GAP_WEIGHT)):
        if len(term.stencil) == 0:
            continue
        k = term.stencil.shape[1]
        row = csr_matrix(
            (term.coefficients.ravel(), (np.repeat(np.arange(len(term.stencil)), k), term.stencil.ravel())),
            shape=(len(term.stencil), size),
        )
        matrix = matrix + weight * (row.T @ diags(term.weight) @ row)
    wish = fold.T @ (_FOLD_WEIGHT * lean * sides[points.chain[chosen]])
    return np.asarray(splu(matrix.tocsc()).solve(wish))


def first_bend(net: PiecewiseDog, at: FloatArray, heights: FloatArray, gaps: FloatArray) -> FloatArray:
    """(V,) normal offsets of a sheet without creases that is bent to a cylinder, by about a radian in all.

    It bends the way in which its handles come nearest to each other, else along its longer side; down at its ends,
    or up where its handles are raised there more than in the middle.
    at (H,2) handles on the flat sheet, heights (H,) of their targets over it, gaps (H,H) between targets; net units
    """
    centred = net.flat - net.flat.mean(axis=0)
    way = np.array([1.0, 0.0]) if np.ptp(centred[:, 0]) >= np.ptp(centred[:, 1]) else np.array([0.0, 1.0])
    steps = at[:, None] - at[None]
    shrunk = np.maximum(np.hypot(steps[..., 0], steps[..., 1]) - gaps, 0.0)
    values, ways = np.linalg.eigh(np.einsum("hk,hkc,hkd->cd", shrunk, steps, steps))
    if values[1] > values[0] + _NO_WAY:
        way = ways[:, 1]
    along = centred @ way
    size = max(float(np.ptp(along)), 1e-300)
    bow = 0.5 * along**2 / size
    place = 0.5 * ((at - net.flat.mean(axis=0)) @ way) ** 2 / size
    up = (place - bow.mean()) @ heights > _NO_WAY
    return np.asarray(bow if up else -bow)


def _couplings(net: PiecewiseDog, count: int) -> FloatArray:
    """(n,n) how much two chains around a patch want to fold to one side (+) or to both (-), at most 1."""
    points = net.crease_points
    kept = np.flatnonzero(~points.end)
    kept = kept[:: max(1, len(kept) // _MAX_COUPLED)]
    bend = _flat_curvature(net)[kept]
    place, chain = points.position[kept], points.chain[kept]
    distance = np.hypot(*(place[:, None] - place[None]).transpose(2, 0, 1))
    closeness = 1.0 / (1.0 + distance)
    total = np.zeros((count, count))
    for vertices, sign in ((points.left_vertices, 1.0), (points.right_vertices, -1.0)):
        for others, other_sign in ((points.left_vertices, 1.0), (points.right_vertices, -1.0)):
            patch = net.vertex_patch[vertices[kept, 0]]
            other = net.vertex_patch[others[kept, 0]]
            agree = sign * other_sign * bend[:, None] * bend[None] * closeness
            agree = np.where(patch[:, None] == other[None], agree, 0.0)
            pairs = coo_matrix((agree.ravel(), (np.repeat(chain, len(kept)), np.tile(chain, len(kept)))),
                               shape=(count, count))  # fmt: skip
            total += pairs.toarray()
    np.fill_diagonal(total, 0.0)
    largest = np.abs(total).max(initial=0.0)
    return total / largest if largest > 0 else total


def _flat_curvature(net: PiecewiseDog) -> FloatArray:
    """(K,) signed curvature of the flat creases from the turning of their tangents, 1 / net unit."""
    points = net.crease_points
    result = np.zeros(len(points.position))
    for chain in np.unique(points.chain):
        mine = np.flatnonzero(points.chain == chain)
        if len(mine) < 2:
            continue
        heading = np.unwrap(np.arctan2(points.tangent[mine, 1], points.tangent[mine, 0]))
        along = points.along[mine]
        spaced = np.concatenate([[True], np.diff(along) > 1e-3])
        if spaced.sum() < 2:
            continue
        slope = np.gradient(heading[spaced], along[spaced])
        result[mine] = np.interp(along, along[spaced], slope)
    return result


def _inner_vertices(net: PiecewiseDog) -> list[tuple[IntArray, BoolArray]]:
    """For each crease vertex inside the sheet with four or more arms: the chains of its arms (d,) and, for
    every choice of sides (2^d,), bit k set where arm k is a mountain, whether paper can fold like that."""
    points = net.crease_points
    ends = np.flatnonzero(points.end)
    places = points.position[ends]
    heading = points.tangent[ends] * np.where(points.along[ends] < 1e-6, 1.0, -1.0)[:, None]
    rim = net.sheet.boundary
    result, done = [], np.zeros(len(ends), dtype=bool)
    for k in range(len(ends)):
        if done[k]:
            continue
        near = np.flatnonzero(np.hypot(*(places - places[k]).T) < 1e-5)
        done[near] = True
        if 4 <= len(near) <= _MAX_ARMS and rim.distance(Point(places[k])) > 1e-5:
            result.append((points.chain[ends[near]], _foldable(heading[near])))
    return result


def _foldable(heading: FloatArray) -> BoolArray:
    """Which sides the arms (d,2) of a vertex may take (2^d,): a bird's foot, or two straight lines that cross.

    Abel et al., Rigid origami vertices: conditions and forcing sets (2016): three arms of one side that leave
    no half-plane free and one arm of the other side; or a straight pair of one side and another that changes.
    """
    d = len(heading)
    angle = np.arctan2(heading[:, 1], heading[:, 0])
    mountain = (np.arange(1 << d)[:, None] >> np.arange(d)) & 1 == 1
    mixed = mountain.any(axis=1) & ~mountain.all(axis=1)
    ok = np.zeros(1 << d, dtype=bool)
    for trio in itertools.combinations(range(d), 3):
        turns = np.sort(angle[list(trio)])
        gaps = np.diff(np.append(turns, turns[0] + 2 * np.pi))
        if gaps.max() < np.pi - _STRAIGHT:
            same = mountain[:, trio].all(axis=1) | ~mountain[:, trio].any(axis=1)
            ok |= same & mixed
    lines = [p for p in itertools.combinations(range(d), 2) if heading[p[0]] @ heading[p[1]] < -np.cos(_STRAIGHT)]
    for (a, b), (c, e) in itertools.permutations(lines, 2):
        ok |= (mountain[:, a] == mountain[:, b]) & (mountain[:, c] != mountain[:, e])
    return ok


def _cost(sides: IntArray, coupling: FloatArray, arms: list[tuple[IntArray, BoolArray]]) -> FloatArray:
    """(m,) cost of choices (m,n)."""
    cost = -np.einsum("mi,ij,mj->m", sides, coupling, sides, optimize=True)
    # Ties go to valleys, then to earlier creases: nothing is left to rounding.
    cost = cost - 1e-6 * sides @ np.linspace(1.0, 0.5, sides.shape[1])
    for chains, foldable in arms:
        code = ((sides[:, chains] < 0) << np.arange(len(chains))).sum(axis=1)
        cost = cost + _VERTEX_COST * ~foldable[code]
    return np.asarray(cost)


def _spread(coupling: FloatArray, given: IntArray) -> IntArray:
    """Sides along a maximum spanning tree of the couplings from the given ones: the strongest wishes come true."""
    sides = given.copy()
    while (sides == 0).any():
        reach = np.abs(coupling) * (sides != 0)[:, None] * (sides == 0)[None]
        if reach.max() <= 1e-12:
            sides[int(np.flatnonzero(sides == 0)[0])] = 1
            continue
        i, j = np.unravel_index(int(reach.argmax()), reach.shape)
        sides[j] = sides[i] * (1 if coupling[i, j] > 0 else -1)
    return sides


def _annealed(
    sides: IntArray, free: IntArray, coupling: FloatArray, arms: list[tuple[IntArray, BoolArray]]
) -> IntArray:
    """Better sides (n,): single free chains are flipped, at first also for the worse (simulated annealing).

    The numbers drawn are always the same, so that a drawing starts the same way every time.
    """
    rng = np.random.default_rng(0)
    # A flip of a chain toggles these bits of the codes of the crease vertices it ends at.
    toggles: list[list[tuple[int, int]]] = [[] for _ in sides]
    for k, (chains, _) in enumerate(arms):
        for chain in np.unique(chains).tolist():
            toggles[chain].append((k, _code(np.where(chains == chain, -1, 1))))
    folds = [foldable.tolist() for _, foldable in arms]
    best = sides.copy()
    least = float(_cost(best[None], coupling, arms)[0])
    for _ in range(_ANNEALINGS):
        sides = best.copy()
        field = coupling @ sides
        codes = [_code(sides[chains]) for chains, _ in arms]
        for temperature in np.geomspace(_HOT, _COLD, _SWEEPS).tolist():
            chances = temperature * rng.standard_exponential(len(free))
            for i, chance in zip(rng.permutation(free).tolist(), chances.tolist(), strict=True):
                worse = sum(folds[k][codes[k]] - folds[k][codes[k] ^ bits] for k, bits in toggles[i])
                if 4.0 * sides[i] * field[i] + _VERTEX_COST * worse > chance:
                    continue
                sides[i] *= -1
                field += 2.0 * sides[i] * coupling[:, i]
                for k, bits in toggles[i]:
                    codes[k] ^= bits
        cost = float(_cost(sides[None], coupling, arms)[0])
        if cost < least:
            best, least = sides.copy(), cost
    return best
