"""The rules of the code base that a reader counts on: layers, borders, sizes, docstrings."""

from __future__ import annotations

import ast
import re
import subprocess
from functools import cache
from pathlib import Path

import obbcli

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "obbcli"
MODULES = sorted(path.relative_to(ROOT).as_posix() for path in PACKAGE.rglob("*.py"))
KERNEL_SOURCES = sorted(
    path.relative_to(ROOT).as_posix()
    for path in (PACKAGE / "kernels").rglob("*")
    if path.suffix in {".cpp", ".hpp"}
)
LONGEST_FILE = 400

# Each may import those of rows above it, and of its own row as long as no circle comes of it.
LAYERS = (
    ("errors", "version"),
    ("files", "arrays", "threads", "spelling", "accuracy", "manual"),
    ("kernels",),
    ("answers",),
    ("mesh",),
    ("motion", "primitives"),
    ("tree",),
    ("questions",),
    ("scene", "sweeps", "study", "view"),
    ("report",),
    ("cli",),
    ("__init__", "__main__"),
)
RANKS = {name: rank for rank, row in enumerate(LAYERS) for name in row}
TOP_LEVEL = {
    "LICENSE",
    "Makefile",
    "README.md",
    "obbcli",
    "pyproject.toml",
    "sample_meshes",
    "tests",
}


@cache
def parse(module: str) -> ast.Module:
    """Return the syntax tree of a file of the package."""
    return ast.parse((ROOT / module).read_text(encoding="utf-8"), module)


def layer(module: str) -> str:
    """Return the part of the package that `obbcli/part.py` or `obbcli/part/file.py` belongs to."""
    return Path(module).parts[1].removesuffix(".py")


def imported(tree: ast.Module) -> set[str]:
    """Return the dotted names a file imports, also inside functions and for annotations alone."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: imports are absolute"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


def layers_imported(module: str) -> set[str]:
    """Return the other parts of the package that a file imports, at any place in it."""
    own = {name.split(".")[1] for name in imported(parse(module)) if name.startswith("obbcli.")}
    return (own & RANKS.keys()) - {layer(module)}


def project_files() -> list[str]:
    """Return the files under version control; in an unpacked archive, all but hidden ones."""
    if (ROOT / ".git").exists():
        command = ["git", "ls-files", "-z", "--cached"]
        listing = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        names = [name for name in listing.stdout.split("\0") if name]
    else:
        names = [path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*") if path.is_file()]
        names = [name for name in names if not re.search(r"(^|/)(\.|__pycache__/)", name)]
    return [name for name in names if (ROOT / name).is_file()]


def test_modules_belong_to_known_layers() -> None:
    assert [module for module in MODULES if layer(module) not in RANKS] == []


def test_modules_import_lower_layers_only() -> None:
    above = {
        module: sorted(
            name for name in layers_imported(module) if RANKS[name] > RANKS[layer(module)]
        )
        for module in MODULES
    }

    assert {module: names for module, names in above.items() if names} == {}


def test_layers_import_each_other_in_no_circle() -> None:
    edges = {name: set[str]() for name in RANKS}
    for module in MODULES:
        edges[layer(module)] |= layers_imported(module)

    settled: set[str] = set()
    while free := {name for name in edges if name not in settled and edges[name] <= settled}:
        settled |= free

    assert settled == edges.keys()


# `Motion.through` makes motions of a class that derives from `Motion`.
KNOWN_CIRCLE = {f"obbcli/motion/{name}.py" for name in ("motion", "path", "pieces")}


def test_modules_import_each_other_in_no_circle() -> None:
    edges = {module: modules_imported(module) - {module} for module in MODULES}

    settled: set[str] = set()
    while free := {m for m in edges if m not in settled and edges[m] - settled <= KNOWN_CIRCLE}:
        settled |= free

    assert edges.keys() - settled == set()


def modules_imported(module: str) -> set[str]:
    """Return the files of the package that a file imports, at any place in it."""
    found = set()
    for name in imported(parse(module)):
        parts = name.split(".")
        for k in (len(parts), len(parts) - 1):
            path = "/".join(parts[:k])
            for candidate in (f"{path}.py", f"{path}/__init__.py"):
                if candidate in MODULES:
                    found.add(candidate)
                    break
            else:
                continue
            break
    return found


def test_only_the_kernels_package_imports_the_extension() -> None:
    def touches(module: str) -> bool:
        return any("_core" in name.split(".") for name in imported(parse(module)))

    assert [module for module in MODULES if touches(module)] == ["obbcli/kernels/__init__.py"]


def test_only_bindings_include_nanobind_or_python() -> None:
    def includes(source: str) -> bool:
        text = (ROOT / source).read_text(encoding="utf-8")
        return bool(re.search(r'#\s*include\s*[<"](?:nanobind/|Python\.h)[^>"]*', text))

    inside = [name for name in KERNEL_SOURCES if Path(name).parent.name != "bindings"]
    assert [name for name in inside if includes(name)] == []


def test_only_the_command_line_exits_or_prints() -> None:
    def ends(module: str) -> bool:
        calls = {ast.unparse(n.func) for n in ast.walk(parse(module)) if isinstance(n, ast.Call)}
        return bool({"print", "exit", "quit", "sys.exit", "os._exit"} & calls)

    below = [module for module in MODULES if layer(module) not in {"cli", "__main__"}]
    assert [module for module in below if ends(module)] == []


def test_public_things_have_docstrings() -> None:
    assert [name for module in MODULES for name in undocumented(module)] == []


def undocumented(module: str) -> list[str]:
    """Return what is public in a module and has no docstring."""
    tree = parse(module)
    missing = [] if ast.get_docstring(tree) else [module]

    def visit(body: list[ast.stmt]) -> None:
        for node in body:
            kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
            if isinstance(node, kinds) and not node.name.startswith("_"):
                if not ast.get_docstring(node) and not is_overload(node):
                    missing.append(f"{module}: {node.name}")
                if isinstance(node, ast.ClassDef):
                    visit(node.body)

    visit(tree.body)
    return missing


def is_overload(node: ast.stmt) -> bool:
    """Return whether a definition only adds a signature to the one that follows it."""
    decorators = getattr(node, "decorator_list", [])
    return any(ast.unparse(one).rpartition(".")[2] == "overload" for one in decorators)


def test_files_are_not_too_long() -> None:
    def length(name: str) -> int:
        return (ROOT / name).read_text(encoding="utf-8").count("\n")

    assert [name for name in MODULES + KERNEL_SOURCES if length(name) > LONGEST_FILE] == []


def test_no_module_hides_a_public_function() -> None:
    # Importing `obbcli.sweep` would put the module in the place of the function.
    modules = {layer(module) for module in MODULES}
    public = set(obbcli.__all__) - {"primitives", "__version__"}

    assert modules & public == set()


def test_top_level_holds_what_it_should() -> None:
    entries = {Path(name).parts[0] for name in project_files()}

    assert {entry for entry in entries if not entry.startswith(".")} <= TOP_LEVEL


def test_no_file_names_a_place_on_somebodys_machine() -> None:
    places = re.compile(rb"(?<![\w.])/(?:home|root|Users|work|tmp|mnt|opt)/\w|[A-Z]:\\\\?Users")
    found = [name for name in project_files() if places.search((ROOT / name).read_bytes())]

    assert not [name for name in found if name != "tests/whole/test_codebase.py"]
