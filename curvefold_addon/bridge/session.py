"""A paper at work: a model that iterates in a thread of its own, and the shape that Blender shows of it.

The thread touches the model and nothing of Blender (``worker``); what is here belongs to the main thread. It can
be thrown away at any time: ``state`` keeps what it is made from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import count
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from ...solver import Handle, HandleError, Measurement, PiecewiseDog, SqpReport, Status, measure
from ...solver.controls.pull import Finding
from ...solver.net.carry_over import carry_over
from . import by_hand, mesh_attributes, nets, state, turns
from . import mesh as surface
from .film import Film
from .hooks import SAME_TARGET, WIDTH, Inputs, handles_begin, same
from .nets import choose, drawn_of, net_of
from .worker import Step, Worker

#: Ends of motions that are kept for undo and redo.
_KEPT_ENDS = 64

Array = NDArray[np.float64]

#: No two shapes have the same version, of whatever session.
_versions = count()


def stop() -> None:
    """Ends the thread and forgets what could be made again."""
    turns.stop()
    _ends.clear()
    nets.forget()
    by_hand.forget()


@dataclass(frozen=True, eq=False)
class Judgement:
    """findings: what was asked and not reached; refused: why controls do not act that do not fit the paper,
    sentences; flows: the part of its way, 0 to 1, that each crease (from 0) with a curve has gone.
    """

    findings: tuple[Finding, ...] = ()
    refused: tuple[str, ...] = ()
    flows: Mapping[int, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Rest:
    """A shape that rests, what it was told (``Inputs.numbers``), and what was said of it, None where nobody did."""

    numbers: Array
    positions: Array
    measurement: Measurement
    judgement: Judgement | None


@dataclass(frozen=True, eq=False)
class Ahead:
    """How a session will be. values: of what moves with its shape, by their names"""

    values: Mapping[str, Any]

    @property
    def positions(self) -> Array:
        """(V,3)"""
        positions: Array = self.values["positions"]
        return positions


#: What moves with the shape of a session.
_MOVES = (
    *("positions", "rest", "before", "run", "origin", "failed", "inputs", "report", "measurement", "judgement"),
    *("iterations", "milliseconds", "_taken", "_counted"),
)


@dataclass(frozen=True, eq=False)
class Snapshot:
    """A session at one moment, for another thread."""

    net: PiecewiseDog
    positions: Array
    rest: Array | None


class Session:
    """net; positions (V,3) as last written to the mesh, the paper's units; version: another number for each shape.

    rest         what the paper was told when it came to rest, None while it moves
    before       the rest from which the present motion started
    drawn        the creases as they are drawn
    judgement    what the thread has said of the shape; None when it has said nothing yet
    run          the name of the motion, in the .blend too; empty when it has none yet
    film         the frames of an animation that the paper has followed
    ahead        where the paper would be after the next frame, as long as it stays; None when nobody has looked
    failed       whether the numbers ran away; the last good shape is kept
    ruled        the version of the shape whose rulings the mesh has, when it is asked for them
    """

    def __init__(self, source: state.Source, net: PiecewiseDog, positions: Array, rest: Array | None) -> None:
        """In any thread: measures the shape, so that nobody has to wait for it later."""
        self.source, self.net = source, net
        self.drawn = drawn_of(source)
        self.positions = positions
        self.rest = rest
        self.before: Rest | None = None
        self.run = ""
        self.origin = ""  # the run that this one began at the rest of
        self.version = next(_versions)
        self.ruled = -1
        self.failed = False
        self.inputs: Inputs | None = None
        self.report: SqpReport | None = None
        self.measurement = measure(net, positions)
        self.judgement: Judgement | None = None
        self.iterations = 0
        self.milliseconds = 0.0
        self.film = Film(self)
        self._worker = Worker(net, positions)
        self._taken: Step | None = None
        self._counted = 0
        self.ahead: Ahead | None = None
        self._written = positions
        self._marked: Measurement | None = None
        self._anew: Rest | None = None
        self._off_sheet: dict[tuple[float, float], str] = {}

    @property
    def said(self) -> Judgement:
        """What the thread has said of the shape, which may be nothing."""
        return self.judgement or Judgement()

    # --- asking ------------------------------------------------------------------------------------------

    def why_not_at(self, at: tuple[float, float]) -> str:
        """Why no handle can be at a point of the flat sheet; empty when one can."""
        if at not in self._off_sheet:
            try:
                self.net.locate(at)
                self._off_sheet[at] = ""
            except HandleError as error:
                self._off_sheet[at] = error.message
        return self._off_sheet[at]

    def place_of(self, at: tuple[float, float]) -> tuple[float, float, float]:
        """Where a point of the flat sheet is now, in the paper's local coordinates. Raises HandleError."""
        vertices, weights = self.net.locate(at)
        x, y, z = (weights @ self.positions[vertices]).tolist()
        return x, y, z

    def found_sides(self) -> tuple[str, ...]:
        """FOLD letter of what each crease is now."""
        present = measure(self.net, self.positions)
        return tuple(present.side(k) for k in range(len(self.drawn)))

    def snapshot(self) -> Snapshot:
        """What another net can take over."""
        return Snapshot(self.net, self.positions, self.rest)

    def rests_with(self, inputs: Inputs) -> bool:
        """Whether the paper rests and is told nothing new, or only to hold points where they are."""
        if self.rest is None:
            return False
        numbers = inputs.numbers()
        if not same(self.rest, numbers, self.net.frame.unit):
            known = numbers[: len(self.rest)]
            if len(known) >= len(numbers) or not same(self.rest, known, self.net.frame.unit):
                return False
            more = inputs.handles[(len(self.rest) - handles_begin(self.rest)) // WIDTH :]
            if not all(self._is_at(handle) for handle in more):
                return False
            self.rest = numbers
        return True

    def _is_at(self, handle: Handle) -> bool:
        gaps = np.abs(np.subtract(self.place_of(handle.at), handle.target))
        return bool(gaps.max() <= SAME_TARGET * self.net.frame.unit)

    @property
    def dirty(self) -> bool:
        """Whether the mesh does not show ``positions`` yet."""
        return self._written is not self.positions

    # --- moving ------------------------------------------------------------------------------------------

    def ask(self, inputs: Inputs, first: bool = False) -> None:
        """Lets the thread iterate until the paper rests; before those of others, when it is the first."""
        self.inputs = inputs
        if self.rests_with(inputs):
            return
        self._stay()
        self._leave_rest()
        self._worker.ask(inputs, first)

    def wait(self, deadline: float) -> None:
        """Waits until the clock (``time.perf_counter``) says ``deadline`` or the thread has nothing to do.

        Raises what went wrong in it.
        """
        self._worker.wait(deadline)

    def collect(self) -> None:
        """Takes over what the thread has found."""
        if self.ahead is None:
            self._take(self._worker.newest)

    def advance(self, inputs: Inputs, iterations: int) -> None:
        """Exactly so many iterations, fewer when the paper comes to rest. Blocking."""
        if self.ahead is None and (self._worker.is_running or self._worker.newest is not self._taken):
            # Where it stopped depends on the clock: from the shape that is shown, it does not.
            self._begin_at(self.positions)
        self._stay()
        self.inputs = inputs
        done = 0
        while done < iterations and not self.rests_with(inputs):
            self._leave_rest()
            step = self._worker.advance(inputs, iterations - done)
            self._take(step)
            done += max(1, step.report.iterations)

    def look_ahead(self, inputs: Inputs, iterations: int) -> Ahead:
        """How the paper will be when it is told this (``advance``), where it may go at once (``arrive``).

        Now it stays as it is. Blocking.
        """
        present = {name: getattr(self, name) for name in _MOVES}
        self.advance(inputs, iterations)
        ahead = Ahead({name: getattr(self, name) for name in _MOVES})
        self._set(present)
        self.ahead = ahead
        return ahead

    def arrive(self, ahead: Ahead) -> None:
        """Goes where the paper was last seen ahead. It must not have moved since."""
        assert self.ahead is ahead
        self._set(ahead.values)
        self.ahead = None

    def move_to(self, positions: Array, rest: Rest | None) -> None:
        """Puts the paper somewhere else at once; at a rest when one is given."""
        self._begin_at(positions)
        self.rest = None if rest is None else rest.numbers
        self.measurement = measure(self.net, positions) if rest is None else rest.measurement
        self.judgement = None if rest is None else rest.judgement

    def keep_shape(self) -> Callable[[], None]:
        """What is returned puts the paper back to how it is now, bit for bit."""
        frame, numbers, positions = self.film.frame, self.rest, self.positions
        measurement, judgement = self.measurement, self.judgement

        def put_back() -> None:
            self.move_to(positions, None if numbers is None else Rest(numbers, positions, measurement, judgement))
            self.film.leave(frame)

        return put_back

    def lay_flat(self) -> None:
        """Puts the flat sheet in place of the shape."""
        self.move_to(flat_positions(self.net), None)

    def fold_anew(self) -> None:
        """From the flat sheet in another way than the paper went before (``FoldModel.fold_anew``)."""
        self.lay_flat()
        self._worker.fold_anew()

    def rest_if_flat(self, inputs: Inputs) -> None:
        """A flat paper that is asked for nothing but to be flat has nothing to do."""
        numbers = inputs.numbers()
        targets = np.array([(*handle.at, 0.0) for handle in inputs.handles]).reshape(-1, 3)
        places = np.array([handle.target for handle in inputs.handles]).reshape(-1, 3)
        near = np.abs(targets - places).max(initial=0.0) <= SAME_TARGET * self.net.frame.unit
        self.inputs = inputs
        asked = inputs.angle or inputs.asks
        if near and not asked and np.array_equal(self.positions, flat_positions(self.net)):
            self.rest = numbers

    def start_anew(self, inputs: Inputs, iterations: int) -> None:
        """The shape that a flat sheet takes when it is told this, whatever the paper did before. Blocking."""
        if self._anew is None or not np.array_equal(self._anew.numbers, inputs.numbers(), equal_nan=True):
            self._worker.join()
            self._worker, self.ahead = Worker(self.net, self.positions), None
            self.lay_flat()
            self.advance(inputs, iterations)
            self._anew = Rest(inputs.numbers(), self.positions, self.measurement, self.judgement)
        self.inputs = inputs
        self.move_to(self._anew.positions, self._anew)

    def is_back_at_start(self, inputs: Inputs) -> bool:
        """Whether the paper is told what it was told before it began to move: the hand took it back."""
        if self.before is None or self.rest is not None:
            return False
        return same(self.before.numbers, inputs.numbers(), self.net.frame.unit)

    def return_to_start(self) -> None:
        """Back to the shape before the motion, bit for bit."""
        if self.before is not None:
            self.move_to(self.before.positions, self.before)

    def reload(self, shape: state.StoredShape) -> None:
        """Goes on from what a mesh carries; nothing is done when that is what is here."""
        told = (self.rest is None) == (shape.rest is None) and (
            self.rest is None or shape.rest is None or np.array_equal(self.rest, shape.rest, equal_nan=True)
        )
        if not (told and self.run == shape.run and np.array_equal(self.positions, shape.positions)):
            self.move_to(shape.positions, None)
            self.rest, self.origin, self.run, self.before = shape.rest, "", shape.run, None
            known = _ends.get(self.run)
            if self.rest is not None and known is not None and np.array_equal(known.rest.positions, self.positions):
                self.judgement = known.rest.judgement
            self.version = next(_versions)
        self._written = self.positions
        self._marked = None

    def _leave_rest(self) -> None:
        if self.rest is None:
            return
        if self.before is None:
            self.before = Rest(self.rest, self.positions, self.measurement, self.judgement)
        self.rest, self.origin, self.run, self.iterations = None, self.run, "", 0
        if self.failed:
            self._begin_at(self.positions)

    def _set(self, values: Mapping[str, Any]) -> None:
        for name, value in values.items():
            setattr(self, name, value)

    def _stay(self) -> None:
        """Another motion begins than the one that was seen ahead."""
        if self.ahead is not None:
            self._begin_at(self.positions)

    def _begin_at(self, positions: Array) -> None:
        self._worker = self._worker.again(positions)
        self.ahead = None
        self._taken, self._counted = None, 0
        self.report, self.failed, self.judgement = None, False, None
        self.positions = positions

    def _take(self, step: Step | None) -> None:
        if step is None or step is self._taken:
            return
        self._taken = step
        self.positions, self.report = step.positions, step.report
        self.judgement = Judgement(step.findings, step.refused, step.flows)
        self.iterations += step.iterations - self._counted
        self._counted = step.iterations
        self.milliseconds = 1000.0 * step.seconds
        self.measurement = step.measurement or self.measurement
        self.failed = step.report.status is Status.NOT_FINITE
        self.rest = step.told.numbers() if step.rests else None

    # --- showing -----------------------------------------------------------------------------------------

    def write(self, mesh: Any) -> None:
        """Shows the present shape and keeps it on the datablock."""
        self._show(mesh)
        if self._marked is not self.measurement or not mesh_attributes.is_measured(mesh):
            mesh_attributes.write_measured(mesh, self.net, self.measurement)
            self._marked = self.measurement
        if self.dirty:
            state.store_positions(mesh, self.positions)
            self._written = self.positions
            self.version = next(_versions)
        if not self.run:
            self.run = uuid4().hex
            state.store_run(mesh, self.run)
        if self.rest is not None:
            state.store_rest(mesh, self.rest)
            rest = Rest(self.rest, self.positions, self.measurement, self.judgement)
            _ends[self.run] = _End(self.source, self.origin, rest)
            while len(_ends) > _KEPT_ENDS:
                del _ends[next(iter(_ends))]

    def show(self, mesh: Any, positions: Array) -> None:
        """Shows another shape than the present one for a moment: nothing of it is kept on the datablock."""
        shown = self.net.render_map.apply(positions)
        if surface.has_geometry_of(mesh, self.net.render_map) and not surface.shows(mesh, shown):
            surface.write_positions(mesh, shown)

    def _show(self, mesh: Any) -> None:
        """Who calls has seen to it that nobody has changed the geometry by hand (``by_hand``)."""
        render_map = self.net.render_map
        lost = not surface.is_marked(mesh)
        if not surface.has_geometry_of(mesh, render_map) or (lost and not surface.can_be_marked(mesh, render_map)):
            surface.fill(mesh, render_map, self.positions)
            return
        if lost:
            surface.mark(mesh, render_map)
        shown = render_map.apply(self.positions)
        if self.dirty or not surface.shows(mesh, shown):
            surface.write_positions(mesh, shown)

    def take_up(self, inputs: Inputs) -> None:
        """After undo and redo: where this motion has ended before, asked the same, the paper is there at once.

        An undo step is written when the hand lets go, in mid-motion; what the user saw is what came after. Where
        nothing of a quick motion was shown by then, both steps have the same mesh, and Blender leaves the present
        one as it is: then the paper goes where it has been when it was last asked the same.
        """
        numbers, unit = inputs.numbers(), self.net.frame.unit
        if self.rest is not None and same(self.rest, numbers, unit):
            return
        own = [_ends[self.run]] if self.rest is None and self.run in _ends else []
        next_ones = [end for end in reversed(_ends.values()) if end.origin == self.run]
        for end in (*own, *next_ones, *reversed(_ends.values())):
            if end.source == self.source and same(end.rest.numbers, numbers, unit):
                if self.rest is not None:
                    self.origin, self.run = self.run, ""  # a motion of its own
                self.move_to(end.rest.positions, end.rest)
                return


@dataclass(frozen=True, eq=False)
class _End:
    """Where a motion ended. origin: the run at whose rest it began; empty when that is not known."""

    source: state.Source
    origin: str
    rest: Rest


#: Where motions ended, by their runs; the newest last.
_ends: dict[str, _End] = {}


def stored_session(shape: state.StoredShape) -> Session:
    """A session that goes on from what a mesh carries. In any thread. Raises CurvefoldError, StateError."""
    net = net_of(shape.source)
    if shape.positions.shape != (len(net.rest), 3):
        raise state.StateError("the kept shape does not belong to the kept drawing")
    session = Session(shape.source, net, shape.positions, shape.rest)
    session.run = shape.run
    return session


def flat_session(wanted: state.Source) -> Session:
    """A session of a new net, flat. Raises CurvefoldError."""
    source = choose(wanted).source
    net = net_of(source)
    return Session(source, net, flat_positions(net), None)


def carried_session(wanted: state.Source, old: Snapshot) -> Session:
    """A session of a new net with the shape of another. In any thread. Raises CurvefoldError."""
    source = choose(wanted).source
    net = net_of(source)
    if np.array_equal(net.rest, old.net.rest) and np.array_equal(net.quads, old.net.quads):
        # Only names have changed, or sides, and those are among the numbers of the rest.
        return Session(source, net, old.positions, old.rest)
    return Session(source, net, carry_over(old.net, old.positions, net), None)


def flat_positions(net: PiecewiseDog) -> Array:
    """(V,3) the flat sheet, the paper's units."""
    return np.column_stack([net.rest, np.zeros(len(net.rest))])
