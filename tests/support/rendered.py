"""SVG as a program draws it that is no browser."""

from __future__ import annotations

import io

import numpy as np

from support.heavy import resvg

WIDTH = 640


def rendered(text: str) -> np.ndarray:
    """Red, green, blue and opacity of each px, (height, WIDTH, 4)."""
    from PIL import Image

    with Image.open(io.BytesIO(bytes(resvg.svg_to_bytes(svg_string=text, width=WIDTH)))) as image:
        return np.asarray(image.convert("RGBA")).astype(int)


def share(image: np.ndarray, colour: str) -> float:
    """Share of the px that have a colour."""
    wanted = [int(colour[at : at + 2], 16) for at in (1, 3, 5)]
    return float(np.mean(np.abs(image[..., :3] - wanted).max(axis=-1) <= 1))
