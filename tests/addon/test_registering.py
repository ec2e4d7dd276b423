"""Switching the extension off and on again."""

import addon_utils
import bpy


def test_everything_is_there(extension):
    assert hasattr(bpy.types, "CURVEFOLD_OT_fold_drawing")
    assert extension("curvefold_addon.cli")._command is not None


def test_off_and_on_again(extension):
    package = extension("solver").__package__.rpartition(".")[0]
    for _ in range(2):
        addon_utils.disable(package, default_set=True)
        assert not hasattr(bpy.types, "CURVEFOLD_OT_fold_drawing")
        assert addon_utils.enable(package, default_set=True) is not None
        assert hasattr(bpy.types, "CURVEFOLD_OT_fold_drawing")
