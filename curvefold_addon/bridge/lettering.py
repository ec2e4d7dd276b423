"""A small alphabet of pixels: labels without fonts, a window or a graphics card."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

#: Five rows a letter, as drawn; "|" parts the letters of a line. Capitals do for small letters too.
_ROWS = """
.#. |##. |.## |##. |### |### |.##. |#.# |### |..# |#..# |#.. |#...# |#..# |.#.
#.# |#.# |#.. |#.# |#.. |#.. |#... |#.# |.#. |..# |#.#. |#.. |##.## |##.# |#.#
### |##. |#.. |#.# |##. |##. |#.## |### |.#. |..# |##.. |#.. |#.#.# |#.## |#.#
#.# |#.# |#.. |#.# |#.. |#.. |#..# |#.# |.#. |#.# |#.#. |#.. |#...# |#..# |#.#
#.# |##. |.## |##. |### |#.. |.##. |#.# |### |.#. |#..# |### |#...# |#..# |.#.

##. |.##. |##. |.## |### |#.# |#.# |#...# |#.# |#.# |###
#.# |#..# |#.# |#.. |.#. |#.# |#.# |#...# |#.# |#.# |..#
##. |#..# |##. |.#. |.#. |#.# |#.# |#.#.# |.#. |.#. |.#.
#.. |#.#. |#.# |..# |.#. |#.# |#.# |##.## |#.# |.#. |#..
#.. |.#.# |#.# |##. |.#. |### |.#. |#...# |#.# |.#. |###

.#. |.#. |##. |##. |#.# |### |.## |### |.#. |.#. |... |... |. |. |... |.
#.# |##. |..# |..# |#.# |#.. |#.. |..# |#.# |#.# |... |... |. |# |..# |.
#.# |.#. |.#. |.#. |### |##. |##. |.#. |.#. |.## |### |... |. |. |.#. |.
#.# |.#. |#.. |..# |..# |..# |#.# |.#. |#.# |..# |... |... |. |# |#.. |.
.#. |### |### |##. |..# |##. |.#. |.#. |.#. |##. |... |### |# |. |... |.
"""
_LETTERS = ("ABCDEFGHIJKLMNO", "PQRSTUVWXYZ", "0123456789-_.:/ ")
_HEIGHT = 5


def _alphabet() -> dict[str, NDArray[np.bool_]]:
    alphabet = {}
    for letters, block in zip(_LETTERS, _ROWS.strip().split("\n\n"), strict=True):
        rows = [[part.strip() for part in line.split("|")] for line in block.split("\n")]
        for k, letter in enumerate(letters):
            alphabet[letter] = np.array([[pixel == "#" for pixel in row[k]] for row in rows])
    return alphabet


_ALPHABET = _alphabet()


def lettering(text: str, scale: int, width: int) -> NDArray[np.bool_]:
    """(5 scale, at most width) pixels of a line of text, top row first; too long a text is cut."""
    gap = np.zeros((_HEIGHT, 1), dtype=bool)
    pieces = [gap]
    for letter in text.upper():
        pieces += [_ALPHABET.get(letter, _ALPHABET["-"]), gap]
    line = np.hstack(pieces)
    grown: NDArray[np.bool_] = np.kron(line, np.ones((scale, scale), dtype=bool)).astype(bool)
    return grown[:, :width]
