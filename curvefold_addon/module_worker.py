"""The command line as a process of its own, for the bpy module: what a batch starts for each drawing.

    python -P module_worker.py USER_FOLDER PACKAGE fold …

A Blender program needs no such thing: it is started again with --command.
"""

import importlib
import os
import signal
import sys


def main() -> int:
    user_folder, package, *argv = sys.argv[1:]
    os.environ["BLENDER_USER_RESOURCES"] = user_folder
    import bpy  # noqa: F401  (brings addon_utils, and reads the variable above)
    import addon_utils  # isort: skip

    addon_utils.enable(package, default_set=True)
    return int(importlib.import_module(f"{package}.curvefold_addon.cli").main(argv))


if __name__ == "__main__":
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # Until the command line hears it: Blender would print the traceback of a KeyboardInterrupt and go on.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender's own clean-up at exit may crash or hang, and the exit code would not be ours.
    os._exit(status)
