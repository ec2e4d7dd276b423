"""The Blender layer of Curvefold: thin, and without numpy outside ``bridge``."""

# Imported inside the functions: ``python -m curvefold_addon`` loads this package before any extension.


def register() -> None:
    from . import cli, operators

    operators.register()
    cli.register()


def unregister() -> None:
    from . import cli, operators

    cli.unregister()
    operators.unregister()
