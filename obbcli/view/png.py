"""PNG files, with nothing but zlib. https://www.w3.org/TR/png."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

from obbcli.view.paint import paint

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.view.picture import Picture

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_RGB = 2
_NONE, _SUB, _UP, _PAETH = 0, 1, 2, 4


def png_bytes(picture: Picture, size: tuple[int, int], zoom: float = 1.0) -> bytes:
    """Return a picture as a PNG file.

    Args:
        picture: what to show.
        size: width and height in pixels.
        zoom: how many times closer than all of it.
    """
    return encode(paint(picture, size, zoom))


def encode(pixels: NDArray[np.uint8]) -> bytes:
    """Return the PNG file of sRGB pixels, (height, width, 3)."""
    height, width, _ = pixels.shape
    header = struct.pack(">IIBBBBB", width, height, 8, _RGB, 0, 0, 0)
    data = zlib.compress(_filtered(pixels).tobytes(), 9)
    chunks = ((b"IHDR", header), (b"sRGB", b"\0"), (b"IDAT", data), (b"IEND", b""))
    return _SIGNATURE + b"".join(_chunk(kind, body) for kind, body in chunks)


def _chunk(kind: bytes, body: bytes) -> bytes:
    checksum = zlib.crc32(kind + body)
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", checksum)


def _filtered(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return rows behind their filter's number: of each row the one that leaves least."""
    height, width, channels = pixels.shape
    now = np.zeros((height, width + 1, channels), np.int16)
    now[:, 1:] = pixels
    above = np.zeros_like(now)
    above[1:] = now[:-1]
    x, a, b, c = now[:, 1:], now[:, :-1], above[:, 1:], above[:, :-1]
    tried = {_NONE: x, _SUB: x - a, _UP: x - b, _PAETH: x - _paeth(a, b, c)}
    rows = np.stack([some.astype(np.uint8).reshape(height, -1) for some in tried.values()])
    # What is nearly 0, of either sign, packs well: the rule of thumb of the specification.
    weights = np.abs(rows.view(np.int8).astype(np.int64)).sum(axis=2)
    best = weights.argmin(axis=0)
    kinds = np.array(list(tried), np.uint8)[best]
    chosen: NDArray[np.uint8] = rows[best, np.arange(height)]
    return np.concatenate([kinds[:, None], chosen], axis=1)


def _paeth(a: NDArray[np.int16], b: NDArray[np.int16], c: NDArray[np.int16]) -> NDArray[np.int16]:
    """Return which of left, above and above left is nearest to a + b - c."""
    p = a + b - c
    to_a, to_b, to_c = np.abs(p - a), np.abs(p - b), np.abs(p - c)
    other = np.where(to_b <= to_c, b, c)
    return np.where((to_a <= to_b) & (to_a <= to_c), a, other)
