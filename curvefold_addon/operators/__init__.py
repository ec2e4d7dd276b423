"""The operators, one a file."""

from . import (
    add_handle,
    add_handles,
    add_joint,
    add_sample,
    add_sheet,
    animate_picture,
    back_to_paper,
    bake,
    check_paper,
    crease_sides,
    draw_crease,
    edit_drawing,
    export_plan,
    flatten,
    fold_anew,
    fold_drawing,
    follow,
    hook_object,
    import_drawing,
    lines_as_objects,
    make_crease,
    make_ordinary_mesh,
    make_paper,
    pick_crease,
    pin,
    place_handle,
    point_angles,
    remove_handle,
    restore_paper,
    set_assignment,
    set_up_picture,
    settle,
    sheet_from_object,
    stroke_crease,
    take_handle,
    usual_weights,
)

_MODULES = (
    add_sheet,
    add_sample,
    sheet_from_object,
    draw_crease,
    stroke_crease,
    edit_drawing,
    make_crease,
    set_assignment,
    import_drawing,
    fold_drawing,
    make_paper,
    back_to_paper,
    add_handle,
    place_handle,
    take_handle,
    add_handles,
    hook_object,
    pin,
    remove_handle,
    crease_sides,
    pick_crease,
    point_angles,
    add_joint,
    usual_weights,
    flatten,
    fold_anew,
    settle,
    restore_paper,
    make_ordinary_mesh,
    check_paper,
    bake,
    lines_as_objects,
    export_plan,
    set_up_picture,
    animate_picture,
    follow,
)


def register() -> None:
    for module in _MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(_MODULES):
        module.unregister()
