"""What the operators on papers have in common."""

import bpy

from ... import solver
from .. import drawing_tool, later_work, live
from ..bridge import linked
from ..bridge.state import StateError


class OnPaper:
    """An operator on the paper that is active, or whose handle is.

    only_looks: whether it changes nothing of the paper, so that it works on linked papers too
    folds: whether it folds the paper at once, so that the paper has to be one that can be folded now
    selects: what has to be selected in Edit Mode, a sentence; empty for operators that need nothing
    """

    only_looks = False
    folds = False
    selects = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        paper = live.active_paper(context)
        if paper is None:
            cls.poll_message_set("Select a paper or one of its handles")
            return False
        reason = "" if cls.only_looks else linked.why_not_changeable(paper.name, paper.data)
        if not reason and cls.folds:
            reason = live.why_it_does_not_fold(paper.data)
        if not reason and cls.selects and paper.mode != "EDIT":
            reason = cls.selects
        if reason:
            cls.poll_message_set(reason)
        return not reason

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        paper = self.meant(context)
        try:
            if not self.only_looks:
                self.check(paper)
            return self.act(context, paper)
        except (solver.CurvefoldError, StateError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    def meant(self, context: bpy.types.Context) -> bpy.types.Object | None:
        """The paper that the operator works on."""
        return live.active_paper(context)

    def check(self, paper: bpy.types.Object) -> None:
        """Before anything is changed. Raises StateError where the paper would not follow."""
        if paper.mode == "EDIT":
            paper.update_from_editmode()
        live.check_follows(paper.data)

    def refuse(self, sentence: str) -> set[str]:
        """Says why nothing was done."""
        self.report({"ERROR"}, sentence)
        return {"CANCELLED"}


class AwaitsClicks(OnPaper):
    """An operator that waits for clicks on the paper in a 3D view.

    what: it deals with, in the plural; without_mouse: what to do instead
    """

    what: str
    cursor: str
    help: str
    without_mouse: str

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            return self.refuse(f"{self.what} are clicked in a 3D view")
        drawing_tool.leave_edit_mode(context)
        paper = live.active_paper(context)
        try:
            live.check_follows(paper.data)
        except StateError as error:
            return self.refuse(str(error))
        self._paper = paper.name
        context.window.cursor_modal_set(self.cursor)
        context.workspace.status_text_set(self.help)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.refuse(self.without_mouse)

    def cancel(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)

    def waiting_paper(self, context: bpy.types.Context) -> bpy.types.Object | None:
        """The paper that the operator began with, as long as it is there."""
        return context.scene.objects.get(self._paper)


def remove_entry(paper: bpy.types.Object, entries: str, active: str, index: int) -> bool:
    """Takes one of a paper's ``entries`` away, for -1 the ``active`` one; whether there was such a one."""
    settings = paper.data.curvefold
    listed = getattr(settings, entries)
    index = getattr(settings, active) if index < 0 else index
    if index >= len(listed):
        return False
    listed.remove(index)
    setattr(settings, active, max(0, min(getattr(settings, active), len(listed) - 1)))
    paper.data.update_tag()
    return True
