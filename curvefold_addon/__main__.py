"""``python -m curvefold_addon fold …``: the extension's command line, in a checkout, with the bpy module.

Installs the checkout as an extension in a new user folder, enables it, and calls what
``blender --command curvefold`` calls.
"""

import importlib
import importlib.util
import os
import sys
import tempfile
from pathlib import Path

from . import checkout


def main() -> int:
    if importlib.util.find_spec("bpy") is None:
        print("curvefold: this Python has no bpy module; scripts/setup.sh makes one that has", file=sys.stderr)
        return 2
    # Not resolved: a link to the checkout is as good as the checkout.
    root = Path(__file__).absolute().parent.parent
    with tempfile.TemporaryDirectory(prefix="curvefold-", ignore_cleanup_errors=True) as folder:
        checkout.link(root, Path(folder))
        checkout.enable(Path(folder))
        cli = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.cli")
        return int(cli.main(sys.argv[1:]))


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender's own clean-up at exit may crash or hang, and the exit code would not be ours.
    os._exit(status)
