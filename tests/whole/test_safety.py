"""What a file or a question from a stranger must not reach: no code, no network, no other program.

The source is read for what could; `test_watched` watches what commands do.
"""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MODULES = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "obbcli").rglob("*.py"))
# The cluster of a sweep is the one way out: Dask speaks to it, and moves pickles.
CLUSTER = "obbcli/sweeps/cluster.py"
# Open CASCADE reads files in a process of its own, which is this interpreter with a module of ours.
STEP_PROCESS = "obbcli/mesh/formats/step/process.py"

UNSAFE_MODULES = {
    *("pickle", "marshal", "shelve", "dill", "cloudpickle", "joblib"),
    *("code", "codeop", "runpy", "pty", "subprocess", "multiprocessing", "concurrent", "ctypes"),
    *("socket", "ssl", "http", "ftplib", "smtplib", "socketserver", "xmlrpc", "webbrowser"),
    *("urllib.request", "requests", "urllib3", "httpx", "aiohttp", "yaml", "h5py", "netCDF4"),
    *("distributed", "dask", "asyncio"),
}
#: Threads of the same process, by name: pools of processes come from the same module.
THREADS = {"concurrent.futures.ThreadPoolExecutor", "concurrent.futures.wait"}
UNSAFE_CALLS = {"eval", "exec", "compile", "__import__", "input", "breakpoint"}
UNSAFE_METHODS = {
    *(f"os.{name}" for name in ("system", "popen", "fork", "execv", "execve", "spawnv")),
    *("os.posix_spawn", "os.startfile", "np.load", "np.memmap", "np.fromfile", "np.ctypeslib"),
}
# Modules named by a table of ours, and never by an input.
IMPORTED_BY_NAME = {
    "obbcli/__init__.py",
    "obbcli/cli/app.py",
    "obbcli/mesh/formats/through_meshio/reader.py",
    "obbcli/mesh/reading.py",
    "obbcli/report/schema/__init__.py",
}


@cache
def parse(module: str) -> ast.Module:
    return ast.parse((ROOT / module).read_text(encoding="utf-8"), module)


def unsafe_imports(tree: ast.Module) -> set[str]:
    """Return the modules that a file imports, at any place, and that no question needs."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    names -= THREADS
    parts = {".".join(name.split(".")[:count]) for name in names for count in (1, 2)}
    return parts & UNSAFE_MODULES


def unsafe_calls(tree: ast.Module) -> set[str]:
    """Return what a file calls that could run what an input says, or read a pickle."""
    found = set()
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        called = ast.unparse(node.func)
        found |= {called} & (UNSAFE_CALLS | UNSAFE_METHODS)
        found |= {"allow_pickle" for word in node.keywords if word.arg == "allow_pickle"}
    return found


def test_modules_import_nothing_that_runs_code_or_reaches_the_network() -> None:
    found = {module: unsafe_imports(parse(module)) for module in MODULES}

    assert found.pop(CLUSTER) <= {"distributed", "asyncio"}
    assert found.pop(STEP_PROCESS) == {"subprocess"}
    assert {module: names for module, names in found.items() if names} == {}


def test_modules_call_nothing_that_runs_what_an_input_says() -> None:
    found = {module: unsafe_calls(parse(module)) for module in MODULES}

    assert {module: names for module, names in found.items() if names} == {}


def test_modules_are_imported_by_name_in_a_few_places_alone() -> None:
    def calls(module: str) -> bool:
        names = {node.id for node in ast.walk(parse(module)) if isinstance(node, ast.Name)}
        return bool(names & {"import_module", "__import__"})

    assert {module for module in MODULES if calls(module)} == IMPORTED_BY_NAME


@pytest.mark.parametrize(
    "source",
    [
        *(
            "import pickle",
            "from urllib.request import urlopen",
            "def f():\n    import socket as s",
        ),
        *("import concurrent.futures", "from concurrent.futures import ProcessPoolExecutor"),
    ],
)
def test_imports_are_found_wherever_they_stand(source: str) -> None:
    assert unsafe_imports(ast.parse(source))


@pytest.mark.parametrize(
    "source",
    ["eval('1')", "os.system(x)", "np.load(x)", "np.asarray(x, allow_pickle=True)"],
)
def test_calls_are_found_wherever_they_stand(source: str) -> None:
    assert unsafe_calls(ast.parse(f"def f(x):\n    return [{source}]"))
