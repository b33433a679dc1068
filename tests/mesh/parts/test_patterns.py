"""Patterns of parts: shell wildcards over whole path elements, by hand and against fnmatch."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest
from hypothesis import given
from hypothesis import strategies as st

from obbcli.mesh.parts.pattern import Pattern, escaped
from obbcli.mesh.parts.placed import UniquePaths

TAKEN = [
    ("arm", "arm"),
    ("arm", "arm/hand/finger"),
    ("arm/hand", "arm/hand/finger"),
    ("arm*", "arm"),
    ("arm*", "arm#2"),
    ("*", "anything"),
    ("*", ""),
    ("**", ""),
    ("**", "a/b/c"),
    ("**/bolt", "bolt"),
    ("**/bolt", "a/b/bolt/head"),
    ("a/**/d", "a/d"),
    ("a/**/d", "a/b/c/d"),
    ("a/**/**/d", "a/d"),
    ("*/arm", "left/arm"),
    ("bolt[12]", "bolt2"),
    ("bolt[!12]", "bolt3"),
    ("bolt[1-3]", "bolt2"),
    ("[]]", "]"),
    ("[a", "[a"),
    ("a]", "a]"),
    (r"\*", "*"),
    (r"\[1]", "[1]"),
    (r"[\]x]", "]"),
    (r"[a\-z]", "-"),
    (r"a\/b", "a/b"),
    ("a\\", "a\\"),
    ("arm#2", "arm#2"),
    ("arm/", "arm/"),
    ("?", "x"),
    ("***", "one"),
]
LEFT = [
    ("arm", "arm#2"),
    ("arm", "armature"),
    ("arm", "left/arm"),
    ("arm", "Arm"),
    ("*/b", "a"),
    ("a/*/d", "a/d"),
    ("a/*/d", "a/b/c/d"),
    ("arm/hand", "arm"),
    ("a**", "b/a"),
    (r"\*", "arm"),
    (r"[a\-z]", "b"),
    ("?", ""),
    ("", "arm"),
    ("arm/", "arm"),
]


@pytest.mark.parametrize(("pattern", "path"), TAKEN)
def test_pattern_takes(pattern, path):
    assert Pattern(pattern).takes(path)


@pytest.mark.parametrize(("pattern", "path"), LEFT)
def test_pattern_leaves(pattern, path):
    assert not Pattern(pattern).takes(path)


def takes(elements, names):
    """Return whether names, or the first of them, match: the definition, element by element."""
    if not elements:
        return True
    if elements[0] == "**":
        return takes(elements[1:], names) or (bool(names) and takes(elements, names[1:]))
    return bool(names) and fnmatchcase(names[0], elements[0]) and takes(elements[1:], names[1:])


WORDS = st.text(alphabet="ab*?", max_size=4).filter(lambda word: "**" not in word)
NAMES = st.text(alphabet="ab#", max_size=4)


@given(
    st.lists(st.just("**") | WORDS, min_size=1, max_size=4), st.lists(NAMES, min_size=1, max_size=5)
)
def test_pattern_is_what_its_definition_says(elements, names):
    assert Pattern("/".join(elements)).takes("/".join(names)) == takes(elements, names)


@given(st.text(alphabet="ab*?[]\\#/-!", max_size=8), st.text(alphabet="ab*?[]\\#/-!", max_size=8))
def test_escaped_path_takes_itself_and_what_stands_below_it(path, other):
    pattern = Pattern(escaped(path))

    assert pattern.takes(path)
    assert pattern.takes(f"{path}/{other}")
    assert pattern.takes(other) == (other == path or other.startswith(f"{path}/"))


def test_pattern_of_many_stars_takes_no_time_that_grows_beyond_the_product_of_lengths():
    # A backtracking match of this would not end.
    assert not Pattern("*a" * 40 + "/**" * 40 + "/b").takes("a" * 4000 + "/c" * 400)


def test_equal_paths_are_numbered_in_order_and_past_names_that_are_there():
    paths = UniquePaths()

    given = [paths.take(path) for path in ("arm", "arm", "arm#2", "arm", "", "", "arm#2", "a\nb")]

    assert given == ["arm", "arm#2", "arm#2#2", "arm#3", "", "#2", "arm#2#3", "a?b"]
