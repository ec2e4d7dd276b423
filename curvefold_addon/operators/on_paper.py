"""What the operators on papers have in common."""

import bpy

from ... import solver
from .. import live
from ..bridge.state import StateError


class OnPaper:
    """An operator on the paper that is active, or whose handle is."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if live.active_paper(context) is None:
            cls.poll_message_set("Select a paper or one of its handles")
            return False
        return True

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
