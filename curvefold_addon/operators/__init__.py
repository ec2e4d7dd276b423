"""The operators, one a file."""

from . import fold_drawing

_MODULES = (fold_drawing,)


def register() -> None:
    for module in _MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(_MODULES):
        module.unregister()
