"""The library of DXF files, imported when the first one is read or written: that takes about a second."""

from __future__ import annotations

import importlib
import json
import logging
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

from .errors import CurvefoldError

#: Where ezdxf keeps its list of fonts, below the variable's folder, and an empty list as it writes one.
_CACHE_VARIABLE = "XDG_CACHE_HOME"
_FONT_LIST = Path("ezdxf", "font_manager_cache.json")
_NO_FONTS = {"version": 2, "font-faces": []}


@cache
def dxf_library() -> Any:
    """The module ``ezdxf``. Raises CurvefoldError when it is not there."""
    # What it mends in damaged files is told by its auditor; nothing of it belongs on the terminal.
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())
    try:
        with _without_fonts():
            library = importlib.import_module("ezdxf")
            importlib.import_module("ezdxf.recover")
    except (ImportError, OSError) as error:
        raise CurvefoldError(f"DXF files need the library ezdxf, which cannot be imported ({error})") from error
    return library


@contextmanager
def _without_fonts() -> Iterator[None]:
    """While it is imported, ezdxf looks through all fonts of the system and writes a list of them into the user's
    folders. It does neither where it finds a list. Lines need no fonts.
    """
    before = os.environ.get(_CACHE_VARIABLE)
    with tempfile.TemporaryDirectory() as folder:
        path = folder / _FONT_LIST
        path.parent.mkdir()
        path.write_text(json.dumps(_NO_FONTS), encoding="utf-8")
        os.environ[_CACHE_VARIABLE] = folder
        try:
            yield
        finally:
            if before is None:
                del os.environ[_CACHE_VARIABLE]
            else:
                os.environ[_CACHE_VARIABLE] = before
