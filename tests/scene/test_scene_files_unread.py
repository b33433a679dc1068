"""Files that are no scene, or cannot be read, are refused by place."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from obbcli import Scene, SceneError
from obbcli.scene import reader as files

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("text", "where", "message"),
    [
        ("duration = \n", ":1", "is no TOML: Invalid value"),
        ('[[body]]\nname = "a"\nname = "b"\n', ":3", "is no TOML: Cannot overwrite a value"),
        ('[[body]]\nname = "a', ":2", "is no TOML"),
        ("a = " + 9 * "9" * 1000, "", "is no TOML: a number has too many digits"),
        ("a = " + "[" * 10_000, "", "is nested too deeply"),
        ('{"body": [\n}', ":2", "is no JSON from column 1 on"),
        ('{"body": [], "body": []}', "", "has the key 'body' twice in one object"),
        ('{"a": ' + "[" * 100_000, "", "is nested too deeply"),
        ('{"a": ' + 9 * "9" * 1000 + "}", "", "is no JSON: a number has too many digits"),
        ("", "", "has no bodies"),
    ],
)
def test_text_that_is_no_scene_is_refused_by_its_line(
    text: str, where: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "cell"
    path.write_text(text)

    with pytest.raises(SceneError) as caught:
        Scene.load(path)

    assert str(caught.value).startswith(f"{path}{where}: ")
    assert message in str(caught.value)


def test_json_file_without_an_object_is_refused(tmp_path: Path) -> None:
    (tmp_path / "cell.json").write_text("[]")

    with pytest.raises(SceneError, match="is no JSON object"):
        Scene.load(tmp_path / "cell.json")


def test_bytes_that_are_no_text_are_refused_by_their_line(tmp_path: Path) -> None:
    (tmp_path / "cell.toml").write_bytes(b"duration = 1\n# \xff\n")

    with pytest.raises(SceneError, match=r"cell\.toml:2: is no text in UTF-8"):
        Scene.load(tmp_path / "cell.toml")


def test_files_that_cannot_be_read_are_refused(tmp_path: Path) -> None:
    (tmp_path / "around.toml").symlink_to("around.toml")

    with pytest.raises(SceneError, match="no such file; check the path"):
        Scene.load(tmp_path / "lost.toml")
    with pytest.raises(SceneError, match="is a folder; name a scene file"):
        Scene.load(tmp_path)
    with pytest.raises(SceneError, match="cannot be read: Too many levels of symbolic links"):
        Scene.load(tmp_path / "around.toml")


def test_huge_files_are_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (tmp_path / "huge.toml").open("wb") as file:
        os.truncate(file.fileno(), 1 << 40)

    with pytest.raises(SceneError, match="is 1099511627776 bytes or more, a scene file has at"):
        Scene.load(tmp_path / "huge.toml")

    # A pipe does not say how long it is.
    monkeypatch.setattr(files, "_MOST_BYTES", 1000)
    (tmp_path / "long.toml").write_text("#" * 1001)
    monkeypatch.setattr(files.Path, "is_file", lambda _: False)
    with pytest.raises(SceneError, match="is 1001 bytes or more, a scene file has at most 1000"):
        Scene.load(tmp_path / "long.toml")
