"""`--plot FILE` of the studies: what could not be drawn is refused before anything is measured."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.cli.boundary import OutputError, UsageError
from obbcli.cli.inputs import keep_inputs

if TYPE_CHECKING:
    from collections.abc import Iterable

_PLOTS = (".svg", ".png")


def check_plot(name: str, output: Path | None, inputs: Iterable[str]) -> None:
    """Refuse a plot that could not be drawn.

    Args:
        name: its file.
        output: where the answer goes; None: to standard output.
        inputs: the files that the command reads.

    Raises:
        UsageError: it is of another kind, over another file of the command, or matplotlib is not
            there.
        OutputError: its folder is not there.
    """
    if Path(name).suffix.lower() not in _PLOTS:
        raise UsageError(f"--plot {name}", "is no .svg or .png file", "name one that is")
    if output is not None and Path(name).resolve() == output.resolve():
        raise UsageError(f"--plot {name}", "is where the answer goes", "name another file")
    if not Path(name).resolve().parent.is_dir():
        raise OutputError(name, "cannot be written: its folder is not there", "create it first")
    if find_spec("matplotlib") is None:
        remedy = "install it: pip install matplotlib"
        raise UsageError("--plot", "needs the package matplotlib", remedy)
    keep_inputs(Path(name), inputs)
