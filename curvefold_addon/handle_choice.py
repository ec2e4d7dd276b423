"""Which handle of a paper is chosen: the one that the active object pulls, else the one that was chosen last.

It is found out when somebody asks, so that nothing has to run when the selection changes.
"""

import bpy

from . import live
from .drawing_context import select_only


def chosen(settings: bpy.types.PropertyGroup) -> int:
    """The index of the chosen handle of a paper; it may be beyond the last one."""
    last, active = settings.active_handle, bpy.context.active_object
    pulled = [] if active is None else [k for k, handle in enumerate(settings.handles) if handle.hook == active]
    return pulled[0] if pulled and last not in pulled else last


def choose(settings: bpy.types.PropertyGroup, index: int) -> None:
    """Chooses a handle, and selects what pulls it; the paper when nothing that can be seen does."""
    settings.active_handle = index
    paper = live.paper_of(settings.id_data)
    if paper is None or bpy.context.mode != "OBJECT" or index >= len(settings.handles):
        return
    hook = settings.handles[index].hook
    select_only(bpy.context, hook if hook is not None and hook.visible_get() else paper)
