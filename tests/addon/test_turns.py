"""Whose turn it is in the thread: the active paper's first, and everybody's at last."""

from threading import Event

import bpy
import pytest

#: Seconds after which a thread is believed to be stuck.
STUCK = 60.0


class Piece:
    """Something that takes turns, so many of them."""

    def __init__(self, name: str, turns: int, order: list[str]) -> None:
        self.name, self.left, self.order = name, turns, order
        self.done = Event()

    @property
    def wants(self) -> bool:
        return self.left > 0

    def iterate(self) -> None:
        self.left -= 1
        self.order.append(self.name)
        if not self.left:
            self.done.set()


@pytest.fixture
def turns(extension, live):
    module = extension("curvefold_addon.bridge.turns")
    module.stop()
    yield module
    module.stop()


@pytest.fixture
def gate(turns):
    """Keeps the thread busy until it is opened."""
    gate = Event()
    turns.pool().submit(gate.wait, STUCK)
    return gate


def rest(turns) -> None:
    """Waits until the thread has done all that was asked of it."""
    while turns.pool().submit(lambda: turns._job is None or not turns._asking).result(STUCK) is False:
        pass


def test_the_first_has_three_of_four_turns(turns, gate):
    order: list[str] = []
    pieces = [Piece(name, 6, order) for name in "abc"]
    for piece in pieces:
        turns.ask(piece, piece.name == "b")
    gate.set()
    for piece in pieces:
        assert piece.done.wait(STUCK)
    assert "".join(order[:8]) == "bbbabbbc"
    assert "".join(order[8:]) == "acacacacac"[: len(order) - 8], "the others take turns"


def test_it_works_on_however_long_nobody_looks(turns, monkeypatch):
    monkeypatch.setattr(turns, "_SPELL", 0.0)
    order: list[str] = []
    piece = Piece("a", 50, order)
    turns.ask(piece, True)
    assert piece.done.wait(STUCK)
    assert len(order) == 50
    rest(turns)
    assert turns._asking == []


def test_other_work_gets_in_between(turns, gate, monkeypatch):
    monkeypatch.setattr(turns, "_SPELL", 0.0)
    order: list[str] = []
    piece = Piece("a", 20, order)
    turns.ask(piece, True)
    built = turns.pool().submit(order.append, "net")
    gate.set()
    built.result(STUCK)
    assert piece.done.wait(STUCK)
    assert order.index("net") == 1


def test_nothing_goes_on_when_nobody_asks_any_more(turns, gate, monkeypatch):
    order: list[str] = []
    piece = Piece("a", 5, order)
    turns.ask(piece, True)
    monkeypatch.setattr(turns, "_UNASKED", -1.0)
    gate.set()
    turns.pool().submit(int).result(STUCK)
    assert order == []
    monkeypatch.setattr(turns, "_UNASKED", STUCK)
    turns.ask(piece, True)
    assert piece.done.wait(STUCK)
    assert len(order) == 5


def test_who_withdraws_has_no_more_turns(turns, gate):
    order: list[str] = []
    gone, stays = Piece("gone", 5, order), Piece("stays", 5, order)
    for piece in (gone, stays):
        turns.ask(piece, piece is gone)
    turns.withdraw(gone)
    gate.set()
    assert stays.done.wait(STUCK)
    assert order == ["stays"] * 5


# --- papers ---------------------------------------------------------------------------------------------------


@pytest.fixture
def papers(extension, sheet, live):
    """Three flat papers that are told to fold; the last one is active."""
    made = []
    for _ in range(3):
        bpy.context.view_layer.objects.active = sheet
        assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
        made.append(bpy.context.object)
    for paper in made:
        live.settle(paper.data)
    for paper in made:
        paper.data.curvefold.fold = 40.0
    bpy.context.view_layer.update()
    return made


@pytest.mark.parametrize("active", [0, 1, 2])
def test_the_active_paper_goes_first(papers, live, active):
    bpy.context.view_layer.objects.active = papers[active]
    live.tick(0.0)
    found = [live.session(paper.data) for paper in papers]
    assert [one.inputs is not None and one.inputs.angle == pytest.approx(36.0) for one in found].index(
        True
    ) == active
    assert live._in_order()[0] == papers[active].data.session_uid


def test_short_ticks_show_every_paper_and_all_come_to_rest(papers, live):
    ticks = 0
    while live.tick(0.0):
        ticks += 1
        assert ticks < 100_000
    assert ticks > len(papers)
    shapes = {bytes(paper.data["curvefold_positions"]) for paper in papers}
    assert len(shapes) == 1, "the same drawing, told the same"
    for paper in papers:
        assert live.session(paper.data).rest is not None
        assert live.report(paper.data).fold_angle == pytest.approx(36.0, abs=1.0)


def test_a_paper_that_was_told_nothing_new_is_not_read_again(papers, live, monkeypatch):
    read = []
    reading = live.hooks.read

    def counted(paper, *arguments):
        read.append(paper.name)
        return reading(paper, *arguments)

    monkeypatch.setattr(live.hooks, "read", counted)
    live.tick(10.0)
    first = len(read)
    assert first >= 1
    for _ in range(5):
        live.tick(10.0)
    assert len(read) <= len(papers), "each is read once"
    papers[0].data.curvefold.fold = 45.0
    live.tick(10.0)
    assert papers[0].name in read[first:]
