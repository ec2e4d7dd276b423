"""What the operators on papers have in common."""

import bpy

from ... import solver
from .. import later_work, live
from ..bridge.state import StateError


class OnPaper:
    """An operator on the paper that is active, or whose handle is."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if live.active_paper(context) is None:
            cls.poll_message_set("Select a paper or one of its handles")
            return False
        return True

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return self.act(context, live.active_paper(context))
        except (solver.CurvefoldError, StateError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

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
