"""`obbtree collide` about moving bodies and clearances: closed forms, limits, exit codes."""

from __future__ import annotations

import pytest

# A cube [0, 1]^3 and, from x = 1 on, one that touches it or is 2^-40 away.


@pytest.mark.parametrize(
    ("other", "words", "status"),
    [
        ("apart.obj", ("--vel", "1", "0", "0"), "contact"),
        ("apart.obj", ("--vel-b", "-1", "0", "0"), "contact"),
        ("apart.obj", ("--vel", "-1", "0", "0"), "separated"),
        ("touching.obj", ("--vel", "-1", "0", "0"), "overlap_at_start"),
        # Contact in the very last moment counts, a moment later it does not.
        ("apart.obj", ("--vel-b", "-1", "0", "0", "--duration", repr(2**-40)), "contact"),
        ("apart.obj", ("--vel-b", "-1", "0", "0", "--duration", repr(2**-41)), "separated"),
        # Turned about its edge at x = 0 the cube leaves; about its centre it sweeps past x = 1.
        ("apart.obj", ("--omega", "0", "0", "90", "--degrees", "--pivot", "0", "0", "0"),
         "separated"),
        ("apart.obj", ("--omega", "0", "0", "1", "--translate-b", "0.1", "0", "0"), "contact"),
        ("apart.obj", ("--omega", "1", "0", "0"), "separated"),
        ("apart.obj", ("--vel", "1", "0", "0", "--vel-b", "1", "0", "0"), "separated"),
        ("apart.obj", ("--clearance", "1e-9"), "overlap_at_start"),
        ("apart.obj", ("--clearance", "0.25", "--translate-b", "0.5", "0", "0"), "separated"),
        ("apart.obj", ("--clearance", "0.25", "--translate-b", "0.5", "0", "0",
                       "--vel", "1", "0", "0"), "contact"),
    ],
)  # fmt: skip
def test_collide_answers_for_the_whole_duration(here, obbtree, other, words, status):
    ended = obbtree("collide", "cube.stl", other, *words, "--json")

    assert ended.code == 0
    assert ended.json["result"]["status"] == status
    assert ended.json["result"]["collides"] is (status != "separated")
    assert (ended.json["result"]["witness"] is None) is (status == "separated")


def test_collide_document_holds_the_motion_as_understood(here, obbtree):
    words = ("--omega", 0, 0, 180, "--degrees", "--pivot", 4, 5, 6, "--vel-b", 1, 2, 3,
             "--translate-b", 99, 0, 0)  # fmt: skip

    motion = obbtree("collide", "cube.stl", "apart.obj", *words, "--json").json["motion"]

    assert motion["duration"] == 1.0
    assert motion["a"]["angular_velocity"] == [0.0, 0.0, pytest.approx(3.141592653589793)]
    assert motion["a"]["pivot"] == [4.0, 5.0, 6.0]
    assert motion["b"]["linear_velocity"] == [1.0, 2.0, 3.0]


# The cubes are [0, 1]^3 and, but for a hair, [1, 2] x [0, 1]^2: their centroids are their middles.
@pytest.mark.parametrize(
    ("words", "pivots"),
    [
        (("--omega", 0, 0, 1), {"A": "0.5 0.5 0.5"}),
        (("--omega", 0, 0, 1, "--translate", 0, 0, 7), {"A": "0.5 0.5 7.5"}),
        (("--omega", 0, 0, 1, "--pivot", 0, 0, 0), {"A": "0 0 0"}),
        (("--omega-b", 0, 0, 1, "--vel", 0, 1, 0), {"B": "1.5 0.5 0.5"}),
        (
            ("--omega", 0, 1, 0, "--omega-b", 0, 0, 1, "--pivot-b", 4, 5, 6),
            {"A": "0.5 0.5 0.5", "B": "4 5 6"},
        ),
        (("--vel", 0, 1, 0), {}),
        (("--rotate", 0, 0, 1), {}),
        (("--omega", 0, 0, 0), {}),
        (("--omega", 0, 0, 1, "--duration", 0), {}),
    ],
)
@pytest.mark.parametrize("command", ["collide", "first-contact", "stability"])
def test_table_tells_about_which_point_a_body_turns(here, obbtree, command, words, pivots):
    lines = obbtree(command, "cube.stl", "apart.obj", *words).out.splitlines()

    told = [line.removeprefix("pivot of ") for line in lines if line.startswith("pivot")]
    assert {line[0]: line[1:].strip() for line in told} == pivots


def test_collide_of_moving_bodies_counts_the_time_of_reading(here, obbtree):
    stats = obbtree("collide", "cube.stl", "apart.obj", "--vel", 1, 0, 0, "--json").json["stats"]

    assert set(stats["seconds"]) == {"load", "query"}
    assert stats["seconds"]["load"] > 0
    assert stats["pops"] > 0


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("--vel", "1", "0", "0"), 1),
        (("--vel", "-1", "0", "0"), 0),
        (("--vel", "1", "0", "0", "--max-iterations", "1"), 4),
        (("--vel", "-1", "0", "0", "--timeout", "0", "--max-iterations", "1"), 4),
        (("--clearance", "1"), 1),
    ],
)
def test_collide_exit_codes_of_moving_bodies(here, obbtree, words, code):
    assert obbtree("collide", "cube.stl", "apart.obj", *words, "--exit-code").code == code


def test_collide_says_that_a_witness_is_near_and_not_met(here, obbtree):
    out = obbtree("collide", "cube.stl", "apart.obj", "--clearance", 1).out

    assert "of A is within the clearance of triangle" in out
