"""Scene files: what they say is understood, and what they should not say is refused by name."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mesh_files.cube_files import cube, stl

from obbcli import Accuracy, MeshError, Scene, SceneError
from obbcli.motion.path import PathMotion

if TYPE_CHECKING:
    from pathlib import Path

WHOLE = """
duration = 2
accuracy = { clearance = 0.25, max_iterations = 1000 }

[[body]]
name = "lid"
mesh = "parts/cube.stl"
pose = { rotation = [0, 0, 1.5], translation = [3, 0, 0.5] }
motion = { linear_velocity = [-1, 0, 0], angular_velocity = [0, 0, 2.5], pivot = [3, 0, 0.5] }
group = "moving"

[[body]]
name = "arm"
mesh = "parts/cube.stl"
group = "moving"

[body.motion]
times = [0, 1.5]
poses = [{ translation = [9, 9, 9] }, { rotation = [0, 0.5, 0] }]

[[body]]
name = "box"
mesh = "parts/cube.stl"
static = true

[[ignore]]
groups = ["moving"]

[[ignore]]
bodies = ["arm", "box"]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with a mesh in it."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "cube.stl").write_bytes(stl(cube()))
    return tmp_path


def tree() -> dict[str, Any]:
    """Return what `WHOLE` says, as a JSON file would."""
    through = [{"translation": [9, 9, 9]}, {"rotation": [0, 0.5, 0]}]
    spin = {"angular_velocity": [0, 0, 2.5], "pivot": [3, 0, 0.5]}
    lid = {"name": "lid", "mesh": "parts/cube.stl", "group": "moving"}
    lid["pose"] = {"rotation": [0, 0, 1.5], "translation": [3, 0, 0.5]}  # type: ignore[assignment]
    lid["motion"] = {"linear_velocity": [-1, 0, 0], **spin}  # type: ignore[assignment]
    arm = {"name": "arm", "mesh": "parts/cube.stl", "group": "moving"}
    arm["motion"] = {"times": [0, 1.5], "poses": through}  # type: ignore[assignment]
    box = {"name": "box", "mesh": "parts/cube.stl", "static": True}
    return {
        "duration": 2,
        "accuracy": {"clearance": 0.25, "max_iterations": 1000},
        "body": [lid, arm, box],
        "ignore": [{"groups": ["moving"]}, {"bodies": ["arm", "box"]}],
    }


def said(scene: Scene) -> list[Any]:
    """Return what a scene holds, as plain values."""
    bodies = []
    for one in scene.bodies:
        motion, pose = one.body.motion, one.body.pose
        if isinstance(motion, PathMotion):
            poses = [(p.rotation.tolist(), p.translation.tolist()) for p in motion.poses]
            how: Any = motion.times.tolist(), poses
        else:
            pivot = None if motion.pivot is None else motion.pivot.tolist()
            how = motion.velocities, pivot
        shape = str(one.body.shape)
        place = pose.rotation.tolist(), pose.translation.tolist()
        bodies.append((one.name, shape, place, how, one.static, one.group))
    return [bodies, scene.ignore, scene.duration, scene.accuracy]


def test_toml_and_json_say_the_same(folder: Path) -> None:
    (folder / "cell.toml").write_text(WHOLE)
    (folder / "cell.json").write_text(json.dumps(tree()))
    (folder / "cell").write_text("\ufeff \n" + json.dumps(tree()), encoding="utf-8")

    scenes = [Scene.load(folder / name) for name in ("cell.toml", "cell.json", "cell")]

    assert said(scenes[0]) == said(scenes[1]) == said(scenes[2])


def test_file_says_what_is_asked(folder: Path) -> None:
    (folder / "cell.toml").write_text(WHOLE)

    scene = Scene.load(str(folder / "cell.toml"))

    lid, arm, box = scene.bodies
    assert (lid.name, lid.group, lid.static, box.static) == ("lid", "moving", False, True)
    assert lid.body.pose.rotation[0, 1] == pytest.approx(-np.sin(1.5))
    assert lid.body.motion.pivot is not None
    assert lid.body.motion.pivot.tolist() == [3, 0, 0.5]
    assert isinstance(arm.body.motion, PathMotion)
    assert arm.body.pose.translation.tolist() == [9, 9, 9]
    assert scene.duration == 2
    assert scene.accuracy == Accuracy(clearance=0.25, max_iterations=1000)
    contacts = scene.first_contacts()
    assert [(one.body_a, one.body_b) for one in contacts] == [("lid", "box")]
    assert contacts.stats.ignored == 2


def test_least_file_has_a_body(folder: Path) -> None:
    (folder / "one.toml").write_text('[[body]]\nname = "a"\nmesh = "parts/cube.stl"\n')

    scene = Scene.load(folder / "one.toml")

    assert scene.duration == 0
    assert list(scene.first_contacts()) == []


def set_at(value: Any, *keys: Any) -> Any:
    """Return what changes `tree()` at a place."""

    def change(root: Any) -> None:
        for key in keys[:-1]:
            root = root[key]
        root[keys[-1]] = value

    return change


def without(*keys: Any) -> Any:
    """Return what removes something from `tree()`."""

    def change(root: Any) -> None:
        for key in keys[:-1]:
            root = root[key]
        del root[keys[-1]]

    return change


BODY, ARM = ("body", 0), ("body", 1)
LID = "body[0] 'lid'"
HUGE = 10**400
REFUSED = {
    "unknown key": (set_at(1, "durations"), "unknown key 'durations'; did you mean 'duration'?"),
    "far from any key": (
        set_at(1, "x"),
        "unknown key 'x'; known are duration, accuracy, solid, unit",
    ),
    "key of a body": (set_at("x", *BODY, "msh"), f"{LID}: unknown key 'msh'; did you mean 'mesh'?"),
    "key of a pose": (set_at([0], *BODY, "pose", "rotate"), f"{LID}.pose: unknown key 'rotate'"),
    "key of a motion": (
        set_at([0], *BODY, "motion", "velocity"),
        f"{LID}.motion: unknown key 'velocity'; did you mean 'linear_velocity'?",
    ),
    "key of an accuracy": (
        set_at(1, "accuracy", "time_tolerence"),
        "accuracy: unknown key 'time_tolerence'; did you mean 'time_tolerance'?",
    ),
    "key of an ignore": (set_at(["a"], "ignore", 0, "body"), "ignore[0]: unknown key 'body'"),
    "negative duration": (set_at(-1, "duration"), "duration: is -1.0; use a finite number of at"),
    "no number": (set_at("2", "duration"), "duration: is '2'; use a finite number"),
    "a truth for a number": (set_at(True, "duration"), "duration: is True"),
    "endless duration": (set_at(float("inf"), "duration"), "duration: is inf"),
    "huge number": (set_at(HUGE, "duration"), "duration: is beyond the largest double"),
    "no finite number": (
        set_at([0, float("nan"), 0], *BODY, "pose", "translation"),
        f"{LID}.pose.translation[1]: is nan; use a finite number",
    ),
    "number as text": (
        set_at(["0", 0, 0], *BODY, "motion", "pivot"),
        f"{LID}.motion.pivot[0]: is '0'",
    ),
    "two numbers": (set_at([0, 1], *BODY, "pose", "rotation"), f"{LID}.pose.rotation: is [0, 1];"),
    "no table": (set_at(3, *BODY, "pose"), f"{LID}.pose: is 3; write a table"),
    "no bodies": (set_at([], "body"), "scene: has no bodies"),
    "bodies left out": (without("body"), "scene: has no bodies"),
    "no array of bodies": (set_at({"name": "a"}, "body"), "write [[body]]"),
    "body without a name": (without(*BODY, "name"), "body[0].name: is missing"),
    "empty name": (set_at("", *BODY, "name"), "name: is ''; give each body a name"),
    "number for a name": (set_at(7, *BODY, "name"), "body[0].name: is 7; give each body a name"),
    "body without a mesh": (without(*BODY, "mesh"), f"{LID}.mesh: is missing; give each body"),
    "two of one name": (
        set_at("lid", *ARM, "name"),
        "body[1]: is called 'lid' like body[0]; give each body a name of its own",
    ),
    "scene in a scene": (set_at("cell.toml", *BODY, "mesh"), "scenes do not hold scenes"),
    "zero byte": (set_at("a\0b", *BODY, "mesh"), f"{LID}.mesh: holds a zero byte"),
    "static that moves": (set_at(True, *BODY, "static"), "'lid': is static and has a motion"),
    "static by a word": (set_at("yes", *BODY, "static"), "body 'lid': static: is 'yes'; use true"),
    "empty group": (set_at("", *BODY, "group"), "body 'lid': group: is ''; use a name"),
    "velocities along a path": (
        set_at([1, 0, 0], *ARM, "motion", "linear_velocity"),
        "body[1] 'arm'.motion: has times and linear_velocity; give times and poses, or velocities",
    ),
    "times alone": (without(*ARM, "motion", "poses"), "motion: has times alone"),
    "times that are no list": (set_at(3, *ARM, "motion", "times"), "times and poses are no lists"),
    "times that fall": (set_at([1, 0], *ARM, "motion", "times"), "motion.times[1]: is 0.0 after"),
    "fewer poses": (set_at([{}], *ARM, "motion", "poses"), "motion.times: 2 for 1 poses"),
    "half a turn": (
        set_at([{}, {"rotation": [np.pi, 0, 0]}], *ARM, "motion", "poses"),
        "motion.piece 0 of the motion, from pose 0 to 1: turns by half a turn",
    ),
    "pose beside a path": (
        set_at({"translation": [1, 0, 0]}, *ARM, "pose"),
        "'arm'.pose: is given beside a motion through poses",
    ),
    "accuracy of another kind": (set_at(3, "accuracy"), "accuracy: is 3; write a table"),
    "accuracy out of range": (set_at(0, "accuracy", "steps"), "accuracy.steps: is 0, expected"),
    "unknown method": (set_at("s", "accuracy", "method"), "accuracy.method: is 's'; use one of"),
    "ignore of neither": (set_at([{}], "ignore"), "ignore[0]: names neither or both"),
    "ignore of both": (set_at(["lid", "arm"], "ignore", 0, "bodies"), "names neither or both"),
    "ignored body": (
        set_at(["lib", "arm"], "ignore", 1, "bodies"),
        "ignore[1].bodies: no body of the scene is called 'lib'; did you mean 'lid'?",
    ),
    "ignored group": (
        set_at(["movin"], "ignore", 0, "groups"),
        "ignore[0].groups: no body of the scene is in group 'movin'; did you mean 'moving'?",
    ),
    "three ignored": (set_at(["lid", "arm", "box"], "ignore", 1, "bodies"), "; list two bodies"),
    "one twice": (set_at(["lid", "lid"], "ignore", 1, "bodies"), "; list two bodies"),
    "ignored by text": (set_at("lid", "ignore", 1, "bodies"), "is 'lid'; list two bodies by name"),
    "ignored by number": (set_at([0, 1], "ignore", 1, "bodies"), "list two bodies by name"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_makes_no_sense_is_refused(case: str, folder: Path) -> None:
    change, message = REFUSED[case]
    root = tree()
    change(root)
    path = folder / "cell.json"
    path.write_text(json.dumps(root))

    with pytest.raises(SceneError) as caught:
        Scene.load(path)

    assert message in str(caught.value)
    assert caught.value.where.startswith(f"{path}: ") or caught.value.where == str(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("mesh", ["lost.stl", "parts", "loop.stl"])
def test_meshes_that_are_not_there_are_refused_when_they_are_needed(
    mesh: str, folder: Path
) -> None:
    (folder / "loop.stl").symlink_to("loop.stl")
    root = tree()
    root["body"][0]["mesh"] = mesh
    (folder / "cell.json").write_text(json.dumps(root))

    scene = Scene.load(folder / "cell.json")

    with pytest.raises((MeshError, OSError), match=mesh):
        scene.first_contacts()


def test_scenes_made_in_code_are_checked_alike() -> None:
    triangle = "triangle.stl"

    with pytest.raises(SceneError, match="scene: has no bodies"):
        Scene([])
    with pytest.raises(SceneError, match=r"body\[0\]: is of type str; pass SceneBody objects"):
        Scene([triangle])  # type: ignore[list-item]
    with pytest.raises(SceneError, match=r"ignore\[0\]: is 'a'; name two bodies"):
        Scene({"a": triangle}, ["a"])  # type: ignore[list-item]
    with pytest.raises(SceneError, match="accuracy: is 3; pass an Accuracy"):
        Scene({"a": triangle}, accuracy=3)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="name: is 3; give each body a name"):
        Scene({3: triangle})  # type: ignore[dict-item]
