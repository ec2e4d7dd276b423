"""What the operators on papers have in common."""

import bpy

from ... import solver
from .. import later_work, live
from ..bridge import linked
from ..bridge.state import StateError


class OnPaper:
    """An operator on the paper that is active, or whose handle is.

    only_looks: whether it changes nothing of the paper, so that it works on linked papers too
    """

    only_looks = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        paper = live.active_paper(context)
        if paper is None:
            cls.poll_message_set("Select a paper or one of its handles")
            return False
        reason = "" if cls.only_looks else linked.why_not_changeable(paper.name, paper.data)
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
