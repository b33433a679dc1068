"""The manual's reference is the code's: commands, options, names, formats, codes, layout."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import click
from manual.pages import (
    PAGES,
    ROOT,
    anchor,
    headings,
    is_explained,
    links,
    section,
    table_rows,
    topic,
    without_code,
)

import obbcli
from obbcli import primitives
from obbcli.cli.app import app
from obbcli.cli.boundary import ExitCode
from obbcli.mesh.formats import FORMATS
from obbcli.tree import header

if TYPE_CHECKING:
    from collections.abc import Iterator

CONTEXT = click.Context(app)
COMMANDS = app.list_commands(CONTEXT)


def command(name: str) -> click.Command:
    """Return a command."""
    found = app.get_command(CONTEXT, name)
    assert found is not None
    return found


def words(name: str) -> Iterator[str]:
    """Yield every option of a command, and every choice of an option or argument."""
    for param in command(name).get_params(click.Context(command(name))):
        if isinstance(param, click.Option):
            yield from param.opts
        if isinstance(param.type, click.Choice):
            yield from param.type.choices


def explained_in(name: str) -> str:
    """Return a command's section, and those of shared options that it links to."""
    own = section(topic("commands"), name)
    shared = topic("options")
    linked = {link.partition("#")[2] for link in links(own) if link.startswith("options.md#")}
    return own + "".join(
        section(shared, heading) for heading in headings(shared) if anchor(heading) in linked
    )


def test_commands_have_a_section_each_in_the_order_of_help() -> None:
    assert headings(topic("commands"))[1:] == COMMANDS


def test_commands_are_listed_as_help_lists_them() -> None:
    listed = re.findall(r"^obbtree (\S+) ", topic("commands"), re.MULTILINE)

    assert listed == COMMANDS


def test_options_and_choices_are_explained_in_the_command_s_section() -> None:
    missing = [
        f"{name} {word}"
        for name in COMMANDS
        for word in sorted(set(words(name)))
        if not is_explained(word, explained_in(name))
    ]

    assert missing == []


def test_options_in_a_command_s_tables_are_its_own() -> None:
    strange = [
        f"{name} {option}"
        for name in COMMANDS
        for row in table_rows(section(topic("commands"), name))
        for option in re.findall(r"(?<![\w-])--?[a-z][\w-]*", row[0])
        if option not in set(words(name))
    ]

    assert strange == []


def test_options_of_the_whole_command_line_are_explained() -> None:
    own = [
        name
        for param in app.get_params(CONTEXT)
        if isinstance(param, click.Option)
        for name in param.opts
    ]

    assert [name for name in own if not is_explained(name, topic("commands"))] == []


def test_public_names_are_explained() -> None:
    names = [*obbcli.__all__, *primitives.__all__]

    assert [name for name in names if not is_explained(name, topic("python"))] == []


def test_format_table_is_the_loader_s() -> None:
    shown = {
        suffix: (name, reader)
        for name, suffixes, reader in table_rows(topic("formats"))
        for suffix in re.findall(r"`(\.\w+)`", suffixes)
    }

    libraries = {"vtk": "VTK", "step": "Open CASCADE"}
    assert shown == {
        suffix: (form.name, "meshio" if form.kind else libraries.get(form.key, "obbtree"))
        for suffix, form in FORMATS.items()
    }


def test_each_reader_of_our_own_has_its_reason() -> None:
    shown = {row[0] for row in table_rows(section(topic("decisions"), "Who reads what"))}
    # Those that a library reads, as far as it can.
    through = {form.name for form in FORMATS.values() if form.kind or form.key in ("vtk", "step")}

    assert shown == {form.name for form in FORMATS.values()} - through


def test_exit_codes_are_those_of_the_command_line() -> None:
    shown = [int(row[0]) for row in table_rows(section(topic("options"), "Exit codes"))]

    assert shown == [code.value for code in ExitCode]


def test_statuses_are_those_of_the_package() -> None:
    shown = [row[0].strip("`") for row in table_rows(section(topic("answers"), "Status"))]

    assert sorted(shown) == sorted(status.value for status in obbcli.Status)


def test_tree_file_header_is_the_one_written() -> None:
    text = section(topic("tree-files"), "The file")
    fields = [row for row in table_rows(text) if row[0].isdigit() and row[1]]
    types = [row[1].strip("`") for row in fields]
    magic = re.search(r"magic: `([0-9A-F ]+)`", text)

    assert "<" + "".join(types) == header.FIXED.format
    assert [int(row[0]) for row in fields][-1] + 4 == header.FIXED.size
    assert magic is not None
    assert bytes.fromhex(magic[1]) == header.MAGIC


def test_layout_names_every_part_of_the_package_and_every_folder_of_tests() -> None:
    layout = section(topic("developing"), "Layout")
    parts = [path for path in (ROOT / "obbcli").iterdir() if path.suffix in {"", ".py"}]
    parts += [path for path in (ROOT / "tests").iterdir() if path.is_dir()]
    names = {f"{path.name}/" if path.is_dir() else path.name for path in parts}
    kept = {name for name in names if not name.startswith(("_", "."))}

    assert sorted(name for name in kept if not re.search(rf"(?<!\S){name}(?!\S)", layout)) == []


def test_paths_that_are_named_are_there() -> None:
    package = ROOT / "obbcli"
    lost = [
        f"{page}: {path}"
        for page, text in PAGES.items()
        for path in re.findall(r"`([\w-]+/[\w./-]*)`", without_code(text))
        for root in (package if (package / path.partition("/")[0]).is_dir() else ROOT,)
        if (root / path.partition("/")[0]).is_dir() and not (root / path).exists()
    ]

    assert lost == []


def test_make_targets_are_those_of_the_makefile() -> None:
    text = (ROOT / "Makefile").read_text(encoding="utf-8").replace("\\\n", " ")
    phony = re.search(r"^\.PHONY: (.*)$", text, re.MULTILINE)
    assert phony is not None
    shown = section(topic("developing"), "What make does")

    assert [name for name in phony[1].split() if not is_explained(name, shown)] == []
