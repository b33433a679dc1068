"""Three numbers of the command line: three words, or one with commas or spaces in it."""

from __future__ import annotations

import pytest


def motion(obbtree, *words):
    """Return the motion that a document tells, of a pair that is asked with these words."""
    return obbtree("collide", "cube.stl", "apart.obj", *words, "--json").json["motion"]


@pytest.mark.parametrize("word", ["1,-2,5e-1", "1 -2 .5", "1, -2 , 0.5", " 1\t-2 0.50 "])
def test_one_word_of_three_numbers_is_three_words(here, obbtree, word):
    spelt = motion(obbtree, "--vel", 1, -2, 0.5)

    assert spelt["a"]["linear_velocity"] == [1.0, -2.0, 0.5]
    assert motion(obbtree, "--vel", word) == spelt
    assert motion(obbtree, f"--vel={word}") == spelt


@pytest.mark.parametrize("suffix", ["", "-b"])
@pytest.mark.parametrize(
    ("options", "place"),
    [
        (("--vel",), ("linear_velocity",)),
        (("--omega",), ("angular_velocity",)),
        (("--omega", "--pivot"), ("pivot",)),
        (("--translate",), ("pose", "translation")),
        (("--rotate",), ("pose", "rotation")),
    ],
)
def test_every_vector_may_be_one_word(here, obbtree, options, place, suffix):
    words = [word for name in options for word in (name + suffix, "-1,0.25,0")]
    apart = [word for name in options for word in (name + suffix, -1, 0.25, 0)]

    told = motion(obbtree, *words)
    rest = motion(obbtree)["b" if suffix else "a"]
    value = told["b" if suffix else "a"]
    for key in place:
        value, rest = value[key], rest[key]

    assert told == motion(obbtree, *apart)
    assert value != rest


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (("1,5", "0", "0"), "1,5"),
        (("1,5 0 0",), "1,5 0 0"),
        (("1,5 0",), "1,5 0"),
        (("1 0",), "1 0"),
        (("1,0,0,0",), "1,0,0,0"),
        (("1,,0",), "1,,0"),
    ],
)
def test_word_that_is_not_three_numbers_is_refused(here, obbtree, words, found):
    ended = obbtree("first-contact", "cube.stl", "apart.obj", "--vel-b", *words)

    assert ended.code == 2
    assert ended.err == (
        f"error: obbtree first-contact: Invalid value for '--vel-b': '{found}' is not three "
        "numbers; write --vel-b X Y Z or --vel-b X,Y,Z; see 'obbtree first-contact --help'\n"
    )


@pytest.mark.parametrize("word", ["1,a,0", "1,5 0,0", "1,nan,0", "1,1_0,0", "0x1 0 0"])
def test_each_number_of_a_word_is_a_finite_number(here, obbtree, word):
    ended = obbtree("collide", "cube.stl", "apart.obj", "--vel", word)

    assert ended.code == 2
    assert ended.err.startswith("error: obbtree collide: Invalid value for '--vel': ")


def test_words_after_two_dashes_are_names(here, obbtree):
    (here / "1,0,0").write_bytes((here / "cube.stl").read_bytes())
    (here / "--vel").write_bytes((here / "cube.stl").read_bytes())

    ended = obbtree("collide", "--quiet", "--", "--vel", "1,0,0")

    assert ended.out == "overlap_at_start\n"


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("--vel", "1", "0"), "Option '--vel' requires 3 arguments"),
        (("--vel",), "Option '--vel' requires 3 arguments"),
        (("--duration",), "Option '--duration' requires an argument"),
        (("--json=1",), "Option '--json' does not take a value"),
        (("--speed", "1"), "No such option '--speed'"),
        (("--vel", "1,0,0", "0", "0"), "Got unexpected extra arguments (0 0)"),
    ],
)
@pytest.mark.parametrize("command", ["collide", "first-contact", "stability"])
def test_usage_errors_name_the_help_of_their_command(here, obbtree, command, words, fault):
    ended = obbtree(command, "cube.stl", "apart.obj", *words)

    assert ended.code == 2
    assert ended.err.startswith(f"error: obbtree {command}: {fault}")
    assert ended.err.endswith(f"see 'obbtree {command} --help'\n")
