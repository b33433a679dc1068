"""Parts of mesh files: what readers tell of them, their paths, and patterns that select some.

A reader that knows parts has, beside `read_FORMAT`, a function `parts_FORMAT(source)` that yields
`PlacedPart`s; what they hold, placed and joined in order, is what `read_FORMAT` returns.
"""

from __future__ import annotations
