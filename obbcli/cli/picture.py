"""The options of `obbtree view` alone: what is drawn, from where, how large."""

from __future__ import annotations

from typing import NamedTuple

from obbcli.cli.options.option import gathered, option
from obbcli.cli.options.words import Finite, Whole

LEVEL = 3
GHOSTS = 3
SIZE = (960, 640)


class ViewOptions(NamedTuple):
    """What is drawn, and how; None where it was not said."""

    level: int | None
    node: int | None
    ghosts: int | None
    view_from: tuple[float, float, float] | None
    zoom: float | None
    size: tuple[int, int] | None
    overlap: bool
    force: bool


_PICTURE = "Picture"
view_options = gathered(
    "how",
    ViewOptions,
    (
        option(
            _PICTURE,
            "--level",
            type=Whole(0),
            metavar="K",
            help=f"Of A alone: draw its boxes at level K, 0 the root box "
            f"[default: {LEVEL}, or the last].",
        ),
        option(
            _PICTURE,
            "--node",
            type=Whole(0),
            metavar="N",
            help="Of A alone: draw the last box above each triangle under box N, 0 the root "
            "[default: the boxes of a level].",
        ),
        option(
            _PICTURE,
            "--ghosts",
            type=Whole(0),
            metavar="N",
            help=f"Draw what moves faintly at N times on its way [default: {GHOSTS}].",
        ),
        option(
            _PICTURE,
            "--from",
            "view_from",
            nargs=3,
            type=Finite(),
            metavar="X Y Z",
            help="Look from this direction, mesh units of any length [default: where the contact "
            "is seen]; not of .glb.",
        ),
        option(
            _PICTURE,
            "--zoom",
            type=Finite(1),
            metavar="N",
            help="Come N times closer to the contact, or to the middle, 1,000,000 at most "
            "[default: 1]; of .png.",
        ),
        option(
            _PICTURE,
            "--size",
            nargs=2,
            type=Whole(16),
            metavar="W H",
            help=f"Width and height in pixels [default: {SIZE[0]} {SIZE[1]}]; of .png.",
        ),
        option(
            _PICTURE,
            "--overlap",
            is_flag=True,
            help="Draw A and B at t = 0 faintly, and in full what they share, by manifold3d.",
        ),
        option(_PICTURE, "--force", is_flag=True, help="Replace a picture that exists."),
    ),
)
