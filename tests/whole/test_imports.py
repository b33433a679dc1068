"""What starting costs: which modules a bare import and a quick command may load."""

from __future__ import annotations

import json
import re
import struct
import subprocess
import sys
from pathlib import Path

import pytest

import obbcli

HEAVY = ("numpy", "rich", "matplotlib", "trimesh", "meshio", "scipy", "obbcli.kernels")


def modules_after(code: str, *arguments: str) -> set[str]:
    """Return the modules that a fresh interpreter holds after running `code`."""
    report = "\nimport sys; print('\\n'.join(['', '#', *sys.modules]))"
    child = subprocess.run(
        [sys.executable, "-c", code + report, *arguments],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(child.stdout.rpartition("\n#\n")[2].split())


QUICK = (
    "import obbcli; obbcli.__version__; dir(obbcli)",
    "from obbcli.cli import main; main(['--version'])",
    "from obbcli.cli import main; main([])",
    "from obbcli.cli import main; main(['--help'])",
    "from obbcli.cli import main; main(['collide', '--help'])",
    "from obbcli.cli import main; main(['build', '--help'])",
    "from obbcli.cli import main; main(['scene', '--help'])",
    "from obbcli.cli import main; main(['sweep', '--help'])",
    "from obbcli.cli import main; main(['tradeoff', '--help'])",
    "from obbcli.cli import main; main(['view', '--help'])",
    "from obbcli.cli import main; main(['view', 'a.stl', '-o', 'a.jpg'])",
    "from obbcli.cli import main; main(['collide', 'a.stl'])",
)
# What each loads that it need not; nothing that is loaded goes again.
LOADED_BY_EACH = """
import json, sys
codes, heavy = json.loads(sys.argv[1])
found = []
for code in codes:
    exec(code)
    found.append([name for name in heavy if name in sys.modules])
print("\\n" + json.dumps(found))
"""


def test_quick_commands_import_nothing_heavy():
    child = subprocess.run(
        [sys.executable, "-c", LOADED_BY_EACH, json.dumps([QUICK, HEAVY])],
        capture_output=True,
        text=True,
        check=True,
    )

    found = json.loads(child.stdout.splitlines()[-1])
    assert {code: names for code, names in zip(QUICK, found, strict=True) if names} == {}


def test_bare_import_loads_no_part_of_the_package():
    loaded = modules_after("import obbcli")

    assert {name for name in loaded if name.startswith("obbcli")} == {"obbcli", "obbcli.version"}


# What a question about two binary STL files needs of the package.
NEEDED = {
    "obbcli",
    "obbcli.accuracy",
    "obbcli.answers",
    "obbcli.answers.collision",
    "obbcli.answers.counts",
    "obbcli.answers.status",
    "obbcli.arrays",
    "obbcli.cli",
    "obbcli.cli.app",
    "obbcli.cli.boundary",
    "obbcli.cli.commands",
    "obbcli.cli.commands.collide",
    "obbcli.cli.inputs",
    "obbcli.cli.options",
    "obbcli.cli.options.accuracy",
    "obbcli.cli.options.option",
    "obbcli.cli.options.placement",
    "obbcli.cli.options.two_bodies",
    "obbcli.cli.options.words",
    "obbcli.cli.output",
    "obbcli.cli.process",
    "obbcli.cli.progress",
    "obbcli.errors",
    "obbcli.files",
    "obbcli.kernels",
    "obbcli.kernels._core",
    "obbcli.mesh",
    "obbcli.mesh.checked_arrays",
    "obbcli.mesh.formats",
    "obbcli.mesh.formats.sniff",
    "obbcli.mesh.formats.stl",
    "obbcli.mesh.formats.text",
    "obbcli.mesh.load",
    "obbcli.mesh.measure",
    "obbcli.mesh.mesh",
    "obbcli.mesh.reading",
    "obbcli.mesh.source",
    "obbcli.mesh.topology",
    "obbcli.motion",
    "obbcli.motion.body",
    "obbcli.motion.motion",
    "obbcli.motion.pose",
    "obbcli.motion.rotation",
    "obbcli.questions",
    "obbcli.questions.border",
    "obbcli.questions.notes",
    "obbcli.questions.pair_question",
    "obbcli.questions.collide",
    "obbcli.report",
    "obbcli.report.collide",
    "obbcli.report.record",
    "obbcli.report.rows",
    "obbcli.report.table",
    "obbcli.threads",
    "obbcli.tree",
    "obbcli.tree.facts",
    "obbcli.tree.file",
    "obbcli.tree.growing",
    "obbcli.tree.header",
    "obbcli.tree.options",
    "obbcli.tree.tree",
    "obbcli.tree.whole",
    "obbcli.version",
}
# And of the standard library, beside what click and NumPy load: small modules, pathlib with its
# parts of one version or other, what gettext looks up, what finds an editable installation.
OTHERS = {
    *("atexit", "bisect", "copy", "dataclasses", "fnmatch", "gc", "glob", "struct", "zlib"),
    *("grp", "pwd"),  # of pathlib since Python 3.13
    *("pathlib", "ntpath", "urllib", "urllib.parse", "ipaddress"),
    "locale",
    "resource",
    "signal",
    *("importlib.util", "importlib._abc"),
}


def test_question_about_stl_files_imports_what_it_needs_and_no_more(tmp_path):
    triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    paths = [tmp_path / "a.stl", tmp_path / "b.stl"]
    for path in paths:
        path.write_bytes(bytes(80) + struct.pack("<I", 1) + triangle)
    code = "import sys; from obbcli.cli import main; main(sys.argv[1:])"

    loaded = modules_after(code, "collide", *map(str, paths))

    beside = loaded - modules_after("import click, numpy")
    own = {name for name in beside if name.partition(".")[0] == "obbcli"}
    assert own == NEEDED
    others = {name for name in beside - own if not name.startswith(("_", "pathlib."))}
    assert others <= OTHERS


@pytest.mark.parametrize("words", [("collide", "{0}", "{0}"), ("info", "{0}")])
def test_answer_into_a_pipe_imports_neither_rich_nor_other_readers(tmp_path, words):
    path = tmp_path / "one.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    code = "import sys; from obbcli.cli import main; main(sys.argv[1:])"

    loaded = modules_after(code, *(word.format(path) for word in words))

    assert not loaded & {"rich", "trimesh", "meshio", "scipy", "tempfile", "fractions"}


def test_png_is_painted_without_libraries_for_pictures(tmp_path):
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    code = "import sys; from obbcli.cli import main; assert main(sys.argv[1:]) == 0"
    words = "view", tmp_path / "one.obj", "--level", "0", "-o", tmp_path / "one.png"

    loaded = modules_after(code, *map(str, words))

    assert (tmp_path / "one.png").is_file()
    assert not loaded & {"trimesh", "matplotlib", "PIL", "scipy", "meshio", "rich"}


def test_public_names_are_there():
    assert [name for name in obbcli.__all__ if getattr(obbcli, name, None) is None] == []
    assert set(obbcli.__all__) <= set(dir(obbcli))


def test_object_that_outlives_the_interpreter_ends_in_silence():
    code = """
import ctypes, obbcli
kept = obbcli.Pose().kernel
ctypes.pythonapi.Py_IncRef(ctypes.py_object(kept))
"""
    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert (child.stdout, child.stderr) == ("", "")


def test_names_lead_to_one_object():
    assert obbcli.Pose is obbcli.Pose
    from obbcli.motion.pose import Pose

    assert obbcli.Pose is Pose


def test_primitives_need_no_import_of_their_own():
    loaded = modules_after("import obbcli; obbcli.primitives.Obb")

    assert "obbcli.primitives" in loaded


def test_unknown_names_are_refused():
    with pytest.raises(AttributeError, match="'obbcli' has no attribute 'nonsense'"):
        _ = obbcli.nonsense


def test_version_is_that_of_the_project():
    text = (Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")

    assert re.search(r'^version = "(.*)"$', text, re.MULTILINE).group(1) == obbcli.__version__


def test_module_runs_as_the_command():
    child = subprocess.run(
        [sys.executable, "-m", "obbcli", "--version"], capture_output=True, text=True, check=True
    )

    assert child.stdout == f"obbtree {obbcli.__version__}\n"
