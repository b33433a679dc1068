"""Make one page of the docstrings of all public names: `make docs`.

Usage: page.py OUTPUT.html
"""

from __future__ import annotations

import collections.abc
import inspect
import sys
import warnings
from pathlib import Path
from types import ModuleType, new_class
from typing import Generic, TypeVar

import numpy.typing
from pdoc.doc import Module
from pdoc.render import configure, html_module

import obbcli
from obbcli import primitives

CONVENTIONS = """\
Lengths are in mesh units, times in s, angles in radians, angular velocities in rad/s; coordinates
are right-handed. What each answer promises stands in the manual: `obbtree manual guarantees`.
"""


def whole() -> ModuleType:
    """Return a module that holds what is public."""
    names = {name: getattr(obbcli, name) for name in obbcli.__all__ if name != "__version__"}
    # Questions first, then what goes in and comes out, then errors.
    names = dict(sorted(names.items(), key=lambda item: _rank(item[1])))
    names["primitives"] = _as_class()
    for one in names.values():
        # What the kernels make is documented as its class writes it.
        if inspect.isclass(one) and "_checked" in vars(one):
            one.__init__ = vars(one)["_checked"]
    page = ModuleType("obbcli", f"{inspect.getdoc(obbcli)}\n\n{CONVENTIONS}")
    # Annotations name them, and their modules import them for type checkers alone.
    annotations = {name: getattr(collections.abc, name) for name in collections.abc.__all__}
    vars(page).update(annotations, **names, __all__=list(names))
    return page


def _as_class() -> type:
    """Return the primitives as a class, which can be shown within the page of another module."""
    names = {name: getattr(primitives, name) for name in primitives.__all__}
    parts = {
        name: value if isinstance(value, type) else staticmethod(value)
        for name, value in names.items()
    }
    text = (inspect.getdoc(primitives) or "").partition("Readers of the paper")[0]
    return type("primitives", (), {"__module__": "obbcli", "__doc__": text, **parts})


def _name_arrays() -> None:
    """Let signatures say `ArrayLike` and `NDArray`, and not what these stand for."""
    scalar = TypeVar("scalar")
    names = {"ArrayLike": (), "NDArray": (Generic[scalar],)}
    for name, bases in names.items():
        made = new_class(name, bases, {}, lambda body: body.update(__module__="numpy.typing"))
        setattr(numpy.typing, name, made)


def _rank(value: object) -> int:
    """Return where a name comes in."""
    if not isinstance(value, type):
        return 0
    return 2 if issubclass(value, Exception) else 1


def main() -> None:
    """Write the page."""
    configure(
        docformat="google",
        footer_text=f"obbtree {obbcli.__version__}",
        include_undocumented=False,
        show_source=False,
        template_directory=Path(__file__).parent / "templates",
    )
    _name_arrays()
    # It finds no module for the fields of named tuples, and shows their annotations as written.
    warnings.filterwarnings("ignore", "Error parsing type annotation ForwardRef")
    page = Module(whole())
    text = html_module(page, all_modules={"obbcli": page})
    Path(sys.argv[1]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
