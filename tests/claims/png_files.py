"""Pictures read by Pillow: what our own PNG files are held to."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

if TYPE_CHECKING:
    from numpy.typing import NDArray


def pixels_of(data: bytes) -> NDArray[np.int64]:
    """Return the pixels of a PNG file, (height, width, 3), 0 to 255.

    Raises:
        AssertionError: it is no PNG file, or has other channels than red, green and blue.
    """
    with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
        assert picture.mode == "RGB", picture.mode
        return np.asarray(picture).astype(np.int64)
