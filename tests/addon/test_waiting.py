"""What is seen at the pointer while an operator holds Blender up."""

from types import SimpleNamespace

import bpy
import pytest


class Manager:
    """Notes what is shown at the pointer."""

    def __init__(self):
        self.shown: list[float] = []
        self.begun = self.ended = 0

    def progress_begin(self, low, high):
        self.begun += 1
        assert (low, high) == (0.0, 1.0)

    def progress_update(self, value):
        self.shown.append(value)

    def progress_end(self):
        self.ended += 1


@pytest.fixture
def manager(extension, monkeypatch):
    """What operators show, noted."""
    waiting = extension("curvefold_addon.waiting")
    manager = Manager()
    begin = waiting.Waiting.__init__
    monkeypatch.setattr(
        waiting.Waiting, "__init__", lambda self, context: begin(self, SimpleNamespace(window_manager=manager))
    )
    return manager


def rises(manager) -> bool:
    shown = manager.shown
    return len(shown) > 1 and shown == sorted(shown) and 0.0 <= shown[0] < shown[-1] <= 1.0


def test_settle_says_how_far_it_is_and_leads_to_the_same_bits(paper, live, manager):
    mesh = paper.data
    mesh.curvefold.fold = 70.0
    assert bpy.ops.curvefold.settle() == {"FINISHED"}
    assert rises(manager)
    assert (manager.begun, manager.ended) == (1, 1)
    told = bytes(mesh["curvefold_positions"])
    mesh.curvefold.fold = 0.0
    bpy.ops.curvefold.flatten()
    mesh.curvefold.fold = 70.0
    live.settle(mesh)
    assert bytes(mesh["curvefold_positions"]) == told


def test_bake_says_which_part_of_the_film_it_has_gone_through(paper, manager):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    for frame, fold in ((1, 30.0), (4, 50.0)):
        paper.data.curvefold.fold = fold
        paper.data.keyframe_insert("curvefold.fold", frame=frame)
    assert bpy.ops.curvefold.bake() == {"FINISHED"}
    assert manager.shown == [0.0, 0.25, 0.5, 0.75]
    assert manager.ended == 1


def test_a_drawing_that_is_imported_folded_says_it(drawing, manager):
    assert bpy.ops.curvefold.fold_drawing(filepath=str(drawing), resolution=12) == {"FINISHED"}
    assert rises(manager)
    assert manager.ended == 1


def test_the_pointer_is_given_back_whatever_happens(extension):
    waiting = extension("curvefold_addon.waiting")
    seen: list[str] = []
    window = SimpleNamespace(cursor_modal_set=seen.append, cursor_modal_restore=lambda: seen.append("restored"))
    with pytest.raises(ZeroDivisionError), waiting.busy(SimpleNamespace(window=window)):
        raise ZeroDivisionError
    assert seen == ["WAIT", "restored"]
    with waiting.busy(SimpleNamespace(window=None)):
        pass
    manager = Manager()
    with pytest.raises(ZeroDivisionError), waiting.Waiting(SimpleNamespace(window_manager=manager)):
        raise ZeroDivisionError
    assert (manager.begun, manager.ended) == (1, 1)
