"""``python -m curvefold_addon fold …``: the extension's command line, in a checkout, with the bpy module.

Installs the checkout as an extension in a new user folder, enables it, and calls what
``blender --command curvefold`` calls.
"""

import importlib
import importlib.util
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path
from types import FrameType

from . import checkout


def main() -> int:
    if importlib.util.find_spec("bpy") is None:
        print("curvefold: this Python has no bpy module; scripts/setup.sh makes one that has", file=sys.stderr)
        return 2
    # Not resolved: a link to the checkout is as good as the checkout.
    root = Path(__file__).absolute().parent.parent
    with tempfile.TemporaryDirectory(prefix="curvefold-", ignore_cleanup_errors=True) as folder:
        _end_at_interrupt(Path(folder))
        checkout.link(root, Path(folder))
        checkout.enable(Path(folder))
        importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.interrupts").remove_at_end(Path(folder))
        cli = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.cli")
        return int(cli.main(sys.argv[1:]))


def _end_at_interrupt(folder: Path) -> None:
    """Until the command line hears Ctrl-C: Blender would print the traceback of a KeyboardInterrupt and go on."""

    def end(number: int, frame: FrameType | None) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        print("curvefold: interrupted", file=sys.stderr, flush=True)
        os._exit(128 + number)

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, end)


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender's own clean-up at exit may crash or hang, and the exit code would not be ours.
    os._exit(status)
