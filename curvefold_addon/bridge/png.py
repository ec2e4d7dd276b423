"""Pictures too large to be held whole, written band by band. Blender holds each pixel as 16 bytes and more."""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
#: Eight bits, red green blue, and nothing special about compression, filters or interlacing.
_KIND = bytes([8, 2, 0, 0, 0])
#: The filter of a row that holds its differences from the row above.
_UP = 2


def write_png(path: Path, width: int, height: int, bands: Iterable[NDArray[np.uint8]]) -> None:
    """Writes bands (h, width, 3), the uppermost first, that are ``height`` rows together. Raises OSError."""
    packer = zlib.compressobj()
    with path.open("wb") as stream:
        stream.write(_SIGNATURE)
        stream.write(_chunk(b"IHDR", width.to_bytes(4, "big") + height.to_bytes(4, "big") + _KIND))
        above = np.zeros((1, width * 3), dtype=np.uint8)
        for band in bands:
            rows = np.concatenate([above, band.reshape(len(band), -1)])
            lines = np.full((len(band), 1 + width * 3), _UP, dtype=np.uint8)
            np.subtract(rows[1:], rows[:-1], out=lines[:, 1:])  # modulo 256, as it should be
            stream.write(_chunk(b"IDAT", packer.compress(lines.tobytes())))
            above = rows[-1:]
        stream.write(_chunk(b"IDAT", packer.flush()))
        stream.write(_chunk(b"IEND", b""))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")
