"""The page: one file, that asks for no other, with the scene and its words inside."""

from __future__ import annotations

import base64
import io
import json
import re
import struct
from html.parser import HTMLParser

import numpy as np
import pytest
import trimesh

from obbcli import Body, Mesh, Motion, ObbTree, Pose, first_contact
from obbcli.view.contact import contact_picture, moment_of
from obbcli.view.html import html_page
from obbcli.view.picture import seen_from

TETRAHEDRON = (
    [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)],
)


class Page(HTMLParser):
    """What a page consists of."""

    def __init__(self, text):
        super().__init__()
        self.tags = []
        self.words = {}
        self._inside = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in {"meta", "link"}:
            self._inside.append(tag)

    def handle_endtag(self, tag):
        assert self._inside.pop() == tag

    def handle_data(self, data):
        if self._inside:
            self.words[self._inside[-1]] = self.words.get(self._inside[-1], "") + data


def page_of(scale=1.0, direction=(1.0, 1.0, 1.0)):
    """Return the page of two tetrahedra that meet, as text."""
    vertices, triangles = TETRAHEDRON
    tree = ObbTree.build(Mesh(scale * np.array(vertices, float), triangles))
    bodies = Body(tree), Body(tree, Pose(translation=(0, 0, 1.5 * scale)), Motion((0, 0, -scale)))
    answer = first_contact(*bodies)
    picture = contact_picture(bodies, answer, moment_of(bodies, answer, 1.0, 2), "a <b> & c")
    picture = seen_from(picture, direction)
    return html_page(picture, ["first line", "<script>alert(1)</script>"]).decode()


def embedded(text):
    """Return the scene inside a page."""
    data = max(re.findall(r'"([A-Za-z0-9+/=]{400,})"', text), key=len)
    return trimesh.load(io.BytesIO(base64.b64decode(data)), file_type="glb", process=False)


def test_page_asks_for_no_other_file():
    text = page_of()

    tags = Page(text).tags
    asking = {"src", "href", "srcset", "data", "action", "poster"}
    assert not [tag for tag in tags if asking & tag[1].keys()]
    assert {tag for tag, _ in tags} <= {
        *("html", "head", "title", "meta", "style", "body", "div", "script"),
    }
    # What the viewer's source holds of addresses: a name space, and places of its own history.
    addresses = set(re.findall(r"https?://[\w.]+", text))
    assert addresses <= {"http://www.w3.org", "https://github.com"}
    assert "@import" not in Page(text).words["style"]


def test_page_has_title_and_words_as_they_are():
    page = Page(page_of())

    assert page.words["title"] == "a <b> & c"
    assert "first line\n<script>alert(1)</script>" in page.words["div"]
    assert [tag for tag, _ in page.tags].count("script") == 1


@pytest.mark.parametrize("scale", [1.0, 1e200, 1e-200])
def test_scene_is_in_a_ball_whatever_its_units(scale):
    scene = embedded(page_of(scale))

    bounds = scene.bounds
    assert {"A at t = 0.5 s", "B at t = 0.5 s", "contact point"} <= set(scene.geometry)
    assert np.linalg.norm(bounds[1] - bounds[0]) == pytest.approx(2.0, rel=0.1)
    # The world reaches from the origin to (1, 1, 2.5); z of the mesh is up on the page: its y.
    for name, height in (("A at t = 0.5 s", 0), ("B at t = 0 s", 1.5), ("B at t = 0.5 s", 1)):
        transform, geometry = scene.graph[name]
        found = trimesh.transform_points(scene.geometry[geometry].vertices, transform)
        x, y, z = (np.array(TETRAHEDRON[0]) + np.array((-0.5, -0.5, height - 1.25))).T
        expected = np.stack([x, z, -y], axis=1) / (np.sqrt(8.25) / 2)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)


def test_body_and_its_ghosts_are_held_once():
    text = page_of()
    data = base64.b64decode(max(re.findall(r'"([A-Za-z0-9+/=]{400,})"', text), key=len))
    header = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])

    places = {
        mesh["name"]: mesh["primitives"][0]["attributes"]["POSITION"] for mesh in header["meshes"]
    }

    assert len({number for name, number in places.items() if name.startswith("B at")}) == 1


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, -2, 0.5)])
def test_camera_looks_at_the_middle_from_the_direction_asked_for(direction):
    scene = embedded(page_of(direction=direction))

    placement = scene.camera_transform
    back = placement[:3, 2]
    x, y, z = np.array(direction) / np.linalg.norm(direction)
    np.testing.assert_allclose(back, (x, z, -y), rtol=0, atol=1e-6)
    assert np.linalg.det(placement[:3, :3]) == pytest.approx(1.0)
    np.testing.assert_allclose(np.cross(placement[:3, 3], back), 0, rtol=0, atol=1e-6)
    assert 2.5 < placement[:3, 3] @ back < 5
