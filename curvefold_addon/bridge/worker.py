"""Iterations in a thread: told anew at any moment, read at any moment, and nothing of Blender in them."""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from threading import Event

import numpy as np
from numpy.typing import NDArray

from ...solver import DescriptionError, FoldModel, Measurement, PiecewiseDog, SqpReport, Status, measure
from ...solver.controls.pull import Finding
from ...solver.controls.registry import control_label
from .controls import in_users_words
from .hooks import Inputs

#: A job ends after so many seconds, so that other papers have their turn and nothing runs when nobody asks.
_TURN = 0.25
#: A moving paper is measured for its report at most this often, seconds.
_MEASURE_EVERY = 0.4

Array = NDArray[np.float64]

_pool: ThreadPoolExecutor | None = None


def pool() -> ThreadPoolExecutor:
    """The one thread in which nets are built and models iterate."""
    global _pool
    if _pool is None:
        _pool = ThreadPoolExecutor(1, "curvefold")
    return _pool


def stop() -> None:
    """Ends the thread; the next job starts another."""
    global _pool
    if _pool is not None:
        _pool.shutdown(wait=True, cancel_futures=True)
    _pool = None


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
    """A model that iterates, in the thread (``start``) or in the caller's (``advance``), never in both.

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
        self._job: Future[None] | None = None
        self._enough = Event()
        self._anew = False
        self._iterations = 0
        self._measured_at = 0.0
        self.newest: Step | None = None

    @property
    def is_running(self) -> bool:
        """Whether a job may be running in the thread."""
        return self._job is not None

    def again(self, positions: Array) -> Worker:
        """A worker that begins elsewhere; what takes long to prepare goes with it.

        Waits for nothing: the thread does one job after the other, and when the new worker's begins, this one's
        is over.
        """
        self._enough.set()
        if self._job is not None and self._job.cancel():
            self._job = None
        worker = Worker(self._net, positions)
        unused = self._job is None and self._model is None
        worker._earlier = self._earlier if unused else self
        return worker

    def fold_anew(self) -> None:
        """Begins with another way from flat. Before the first iteration."""
        self._anew = True

    def work(self, inputs: Inputs, deadline: float) -> None:
        """Lets the thread work on the newest inputs, and waits until the clock says ``deadline`` or it rests.

        The thread goes on afterwards, while Blender draws. Raises what went wrong in the thread.
        """
        self._asked = inputs
        if self._job is None:
            self._enough.clear()
            self._job = pool().submit(self._turn)
        job = self._job
        try:
            job.result(timeout=max(0.0, deadline - time.perf_counter()))
        except TimeoutError:
            return
        finally:
            if job.done():
                self._job = None

    def advance(self, inputs: Inputs, iterations: int) -> Step:
        """So many iterations, fewer when it comes to rest. Blocking."""
        self.join()
        self.newest = self._step(inputs, iterations, measured=True)
        return self.newest

    def join(self) -> None:
        """Waits for the running job, and for one of the worker that this one began as."""
        if self._earlier is not None and self._earlier._job is not None:
            wait([self._earlier._job])  # what went wrong in it matters no more
        job, self._job = self._job, None
        self._enough.set()
        if job is not None and not job.cancel():
            job.result()

    def _turn(self) -> None:
        end = time.perf_counter() + _TURN
        while True:
            asked = self._asked
            assert asked is not None
            self.newest = step = self._step(asked, 1)
            late = self._enough.is_set() or time.perf_counter() > end
            if late or (step.rests and self._asked == asked) or step.report.status is Status.NOT_FINITE:
                return

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
