"""`--method sampled`: documents, tables, exit codes, what goes with it and what does not."""

from __future__ import annotations

import math

import pytest

from obbcli import Accuracy

# A cube beside another, which turns into it: its corner reaches 0.2071 further after an eighth.
TURN = ("--translate-b", 0.1, 0, 0, "--omega", 0, 0, 1)
SAMPLED = ("--method", "sampled")


@pytest.mark.parametrize("integrator", ["exact", "euler", "rk4"])
@pytest.mark.parametrize("command", ["first-contact", "collide"])
def test_sampled_document_says_what_was_asked_and_how_far_off_it_is(
    here, obbtree, command, integrator
):
    ended = obbtree(command, "cube.stl", "touching.obj", *TURN, *SAMPLED, "--steps", 50,
                    "--integrator", integrator, "--json")  # fmt: skip

    document = ended.json
    asked = Accuracy(method="sampled", integrator=integrator, steps=50)
    assert ended.code == 0
    assert document["accuracy"] == asked.as_dict()
    result = document["result"]
    assert result["status"] == "contact"
    assert result["approximate"] is True
    assert 0.9 * math.sqrt(0.5) / 50 < result["error_bound"] < 1.2 * math.sqrt(0.5) / 50
    if command == "first-contact":
        truth = math.pi / 4 - math.acos(0.6 / math.sqrt(0.5))
        low, high = result["time_bounds"]
        assert result["evidence"] == "sampled"
        assert truth - 1e-3 <= low == high <= truth + 0.025
    else:
        assert result["collides"] is True
        assert len(result["witness"]) == 2


@pytest.mark.parametrize(
    ("words", "code", "status"),
    [
        (("--steps", 50), 1, "contact"),
        # Of one step there is no frame but the first.
        (("--steps", 1), 4, "separated"),
        (("--steps", 1, "--translate-b", 0, 0, 0), 1, "overlap_at_start"),
        # Nothing moves, so that nothing is sampled.
        (("--omega", 0, 0, 0), 0, "separated"),
        (("--duration", 0), 0, "separated"),
    ],
)
@pytest.mark.parametrize("command", ["first-contact", "collide"])
def test_exit_code_takes_no_samples_for_proof(here, obbtree, command, words, code, status):
    ended = obbtree(command, "cube.stl", "touching.obj", *TURN, *SAMPLED, *words, "--quiet",
                    "--exit-code")  # fmt: skip
    plain = obbtree(command, "cube.stl", "touching.obj", *TURN, *SAMPLED, *words, "--quiet")

    assert (ended.code, plain.code) == (code, 0)
    assert ended.out.split()[0] == status


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--steps", 1), "as sampled, on paths at most 0.67801 off the true ones"),
        (("--steps", 50), "as sampled, on paths at most 0.0141419 off the true ones"),
        (("--steps", 50, "--max-depth", 0), "of boxes as sampled: the surfaces are at most "),
        (("--vel", -1, 0, 0, "--omega", 0, 0, 0), "as sampled, on the true paths"),
        (("--vel", 1, 0, 0, "--omega", 0, 0, 0), "as sampled, on the true paths"),
        (("--translate-b", 0, 0, 0), "in contact at t = 0\n"),
        (("--translate-b", 0, 0, 0, "--max-depth", 0), "in contact at t = 0 of boxes: "),
        (("--max-iterations", 1), "a limit was reached"),
    ],
)
@pytest.mark.parametrize("command", ["first-contact", "collide"])
def test_sampled_table_claims_no_proof(here, obbtree, command, words, sentence):
    ended = obbtree(command, "cube.stl", "touching.obj", *TURN, *SAMPLED, *words)

    answer = next(line for line in ended.out.splitlines() if line.startswith("answer"))
    assert sentence in answer + "\n"
    assert "bracket" not in ended.out
    assert "proven" not in ended.out


def test_step_that_euler_cannot_follow_is_named_by_its_option(here, obbtree):
    words = ("--omega", 1e15, 1e15, 0, *SAMPLED, "--integrator", "euler", "--steps", 2)

    ended = obbtree("first-contact", "cube.stl", "touching.obj", *TURN, *words)

    assert ended.code == 2
    assert ended.err.startswith("error: --steps: too few: one turns by ")


def test_progress_of_samples_claims_no_proof(here, monkeypatch, obbtree):
    shown = []
    monkeypatch.setattr("obbcli.cli.options.two_bodies._LOOK", 0.0)
    monkeypatch.setattr("obbcli.cli.options.two_bodies.proving", recorder(shown))
    words = ("--translate-b", 3, 0, 0, *SAMPLED, "--steps", 5)

    obbtree("first-contact", "cube.stl", "touching.obj", *TURN, *words)
    certified = obbtree("first-contact", "cube.stl", "touching.obj", *TURN, "--omega", 0, 0, 9)

    assert shown[:6] == ["sampled until", 0.2, 0.4, 0.6, 0.8, "no contact before"]
    assert certified.code == 0


def recorder(shown):
    """Return what takes the place of a progress display."""
    from contextlib import contextmanager

    @contextmanager
    def proving(duration, what, *, wanted):
        shown.append(what)
        yield shown.append

    return proving
