"""Iterations in a thread: told anew at any moment, read at any moment, and nothing of Blender in them."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from threading import Event, Lock

import numpy as np
from numpy.typing import NDArray

from ...solver import DescriptionError, FoldModel, Measurement, PiecewiseDog, SqpReport, Status, measure
from ...solver.controls.pull import Finding
from ...solver.controls.registry import control_label
from . import turns
from .controls import in_users_words
from .hooks import Inputs

#: A moving paper is measured for its report at most this often, seconds.
_MEASURE_EVERY = 0.4

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Step:
    """A shape on its way. positions (V,3); report: of the last iteration; told: what it was on its way to.

    iterations: since the worker was made; measurement: None when it was not due; findings: what was asked and not
    reached, when it has come to rest; refused: why controls do not act that do not fit the paper; seconds: of one
    iteration; flows: the part of its way, 0 to 1, that each crease (from 0) with a curve has gone
    """

    positions: Array
    told: Inputs
    report: SqpReport
    iterations: int
    measurement: Measurement | None
    findings: tuple[Finding, ...]
    refused: tuple[str, ...]
    seconds: float
    flows: dict[int, float]

    @property
    def rests(self) -> bool:
        """Whether there is nothing more to do."""
        return self.report.status is not Status.RUNNING


class Worker:
    """A model that iterates, in the thread (``ask``) or in the caller's (``advance``), never in both.

    newest: the last step, whoever made it; None before the first
    """

    def __init__(self, net: PiecewiseDog, positions: Array) -> None:
        self._net, self._positions = net, positions
        self._model: FoldModel | None = None
        #: Whose model this one goes on with.
        self._earlier: Worker | None = None
        self._told: Inputs | None = None
        self._refused: tuple[str, ...] = ()
        self._asked: Inputs | None = None
        self._fault: BaseException | None = None
        #: Set while the thread has nothing to do here.
        self._done = Event()
        self._done.set()
        #: Held for an iteration.
        self._iterating = Lock()
        self._anew = False
        self._iterations = 0
        self._measured_at = 0.0
        self.newest: Step | None = None

    @property
    def wants(self) -> bool:
        """Whether the thread has something to do here."""
        return not self._done.is_set()

    @property
    def is_running(self) -> bool:
        """Whether the thread may be iterating here."""
        return self.wants or self._iterating.locked()

    def again(self, positions: Array) -> Worker:
        """A worker that begins elsewhere; what takes long to prepare goes with it.

        Waits for nothing: the thread makes one iteration after the other, and when the new worker's begins, this
        one's is over.
        """
        self._withdraw()
        worker = Worker(self._net, positions)
        unused = not self._iterating.locked() and self._model is None
        worker._earlier = self._earlier if unused else self
        return worker

    def fold_anew(self) -> None:
        """Begins with another way from flat. Before the first iteration."""
        self._anew = True

    def ask(self, inputs: Inputs, first: bool = False) -> None:
        """Lets the thread work on the newest inputs until it rests; before all others, when it is the first."""
        step = self.newest
        if step is not None and step.told == inputs and _is_over(step) and self._asked == inputs:
            return
        self._asked = inputs
        self._done.clear()
        turns.ask(self, first)

    def wait(self, deadline: float) -> None:
        """Waits until the clock says ``deadline`` or nothing is left to do. Raises the fault of the thread."""
        self._done.wait(max(0.0, deadline - time.perf_counter()))
        fault, self._fault = self._fault, None
        if fault is not None:
            raise fault

    def advance(self, inputs: Inputs, iterations: int) -> Step:
        """So many iterations, fewer when it comes to rest. Blocking."""
        self.join()
        self.newest = self._step(inputs, iterations, measured=True)
        return self.newest

    def join(self) -> None:
        """Waits until the thread does no more here, nor for the worker that this one began as."""
        for worker in (self._earlier, self):
            if worker is not None:
                worker._withdraw()
                with worker._iterating:
                    pass
        self._fault = None

    def iterate(self) -> None:
        """In the thread: one iteration."""
        asked = self._asked
        assert asked is not None
        with self._iterating:
            if not self.wants:
                return
            try:
                self.newest = step = self._step(asked, 1)
            except Exception as error:
                self._fault = error
                self._done.set()
                return
        if _is_over(step):
            self._done.set()
            if self._asked != asked:
                self._done.clear()  # told something else meanwhile

    def _withdraw(self) -> None:
        turns.withdraw(self)
        self._done.set()

    def _prepared(self) -> FoldModel | None:
        """The model; at first that of the earlier worker, moved to where this one begins."""
        earlier, self._earlier = self._earlier, None
        model = None if earlier is None else earlier._prepared()
        if model is not None:
            self._model = model.again(self._positions)
        return self._model

    def _step(self, inputs: Inputs, iterations: int, measured: bool = False) -> Step:
        model, told = self._prepared(), self._told
        if model is None or model.weights != inputs.weights:
            model = self._model = FoldModel(
                self._net, self._positions if model is None else model.positions, inputs.weights
            )
            told = None
        self._told = inputs
        if told is None or told.handles != inputs.handles:
            model.set_handles(inputs.handles)
        if told is None or told.angle != inputs.angle:
            model.set_fold_angle(inputs.angle)
        if told is None or told.least_fold != inputs.least_fold:
            model.set_least_fold(inputs.least_fold)
        if told is None or told.controls != inputs.controls:
            self._refused = _set_controls(model, inputs)
        if self._anew:
            self._anew = False
            model.fold_anew()
        begin = time.perf_counter()
        report = model.advance(iterations)
        now = time.perf_counter()
        self._iterations += report.iterations
        over = report.status is not Status.RUNNING
        measured = measured or over or now - self._measured_at > _MEASURE_EVERY
        if measured:
            self._measured_at = now
        return Step(
            model.positions,
            inputs,
            report,
            self._iterations,
            measure(self._net, model.positions) if measured else None,
            _found(model) if over else (),
            self._refused,
            (now - begin) / max(1, report.iterations),
            model.flow_progress,
        )


def _is_over(step: Step) -> bool:
    """Whether nothing comes of going on."""
    return step.rests or step.report.status is Status.NOT_FINITE


def _found(model: FoldModel) -> tuple[Finding, ...]:
    """What was asked and not reached, with creases called by their names."""
    labels = model.net.crease_labels
    return tuple(replace(found, sentence=in_users_words(found.sentence, labels)) for found in model.findings)


def _set_controls(model: FoldModel, inputs: Inputs) -> tuple[str, ...]:
    """Sets those that fit the net; why others do not act, one sentence each."""
    controls, names = list(inputs.controls), list(inputs.names)
    refused: list[str] = []
    while True:
        try:
            model.set_controls(controls)
        except DescriptionError as error:
            labels = [control_label(k, control.kind) for k, control in enumerate(controls)]
            wrong = labels.index(error.where.element or "")
            sentence = in_users_words(error.message, model.net.crease_labels)
            name = names[wrong]
            refused.append(sentence if sentence.startswith(name) else f"{name}: {sentence}")
            del controls[wrong], names[wrong]
        else:
            return tuple(refused)
