"""VTK's own readers, asked quietly: what it prints becomes one error, and it sees bytes, no files.

Only its modules for reading are imported, none of which needs OpenGL. They come with the package
`vtk`, which need not be there.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.mesh.source import Source

_XML_READERS = {
    "UnstructuredGrid": "vtkXMLUnstructuredGridReader",
    "PolyData": "vtkXMLPolyDataReader",
    "ImageData": "vtkXMLImageDataReader",
    "StructuredGrid": "vtkXMLStructuredGridReader",
    "RectilinearGrid": "vtkXMLRectilinearGridReader",
}
#: Which cells are copies or hidden; all other values at points and cells are results.
GHOSTS = "vtkGhostType"
#: Where VTK writes to is one setting for the whole process.
_OUTPUT = Lock()
_COMPLAINT = re.compile(r"(?:ERROR|Warning): In [^\n]*\n\w+ \(\w+\): ([^\n]*)")


def has_vtk() -> bool:
    """Return whether VTK can be imported."""
    try:
        from vtkmodules import vtkIOLegacy, vtkIOXML  # noqa: F401 - only whether they are there
    except ImportError:
        return False
    return True


def legacy_data_set(source: Source, data: bytes) -> Any:
    """Return the data set in a legacy file, as VTK has it.

    Raises:
        MeshError: VTK complains.
    """
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader

    def read() -> Any:
        reader: Any = vtkGenericDataObjectReader()
        reader.ReadFromInputStringOn()
        reader.SetBinaryInputString(data, len(data))
        reader.Update()
        return reader.GetOutputDataObject(0)

    return _quietly(source, read)


def xml_data_set(source: Source, kind: str, data: bytes) -> Any:
    """Return the data set in an XML file, as VTK has it, without results.

    Raises:
        MeshError: VTK complains.
    """
    from vtkmodules import vtkIOXML

    def read() -> Any:
        reader = getattr(vtkIOXML, _XML_READERS[kind])()
        reader.ReadFromInputStringOn()
        reader.SetInputString(data)
        reader.UpdateInformation()
        for selection in (reader.GetPointDataArraySelection(), reader.GetCellDataArraySelection()):
            selection.DisableAllArrays()
            if selection.ArrayExists(GHOSTS):
                selection.EnableArray(GHOSTS)
        reader.Update()
        return reader.GetOutputDataObject(0)

    return _quietly(source, read)


def _quietly(source: Source, read: Callable[[], Any]) -> Any:
    """Return what `read` returns, unless VTK complains meanwhile."""
    with _OUTPUT, _kept_output() as window:
        found = read()
        said = window.GetOutput()
    if isinstance(said, bytes):  # where it quotes what is no UTF-8
        said = said.decode(errors="replace")
    if said or found is None:
        words = _COMPLAINT.findall(said)
        what = " ".join(words[0].split())[:200] if words else "it holds nothing"
        raise source.error(f"VTK cannot read it whole: {what}", "export it again")
    return found


@contextmanager
def _kept_output() -> Iterator[Any]:
    """Give the window that keeps all that VTK says, which no terminal then shows."""
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

    before, verbosity = vtkOutputWindow.GetInstance(), vtkLogger.GetCurrentVerbosityCutoff()
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield window
    finally:
        vtkLogger.SetStderrVerbosity(verbosity)
        vtkOutputWindow.SetInstance(before)
