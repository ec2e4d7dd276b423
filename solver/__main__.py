"""``python -m solver fold PATTERN.svg --out DIR``: see ``command_line``."""

import sys

from .command_line import main

sys.exit(main(None, sys.stderr))
