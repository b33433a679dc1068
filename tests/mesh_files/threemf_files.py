"""3MF archives made by hand."""

from __future__ import annotations

import io
import zipfile

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
LINKS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Id="r" Target="/3D/3dmodel.model" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
#: A triangle with corners at 0, 1 along x and 2 along y.
MESH = (
    '<mesh><vertices>\n<vertex x="0" y="0" z="0"/>\n<vertex x="1" y="0" z="0"/>\n'
    '<vertex x="0" y="2" z="0"/></vertices>\n'
    '<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh>'
)
SHIFT = 'transform="1 0 0 0 1 0 0 0 1 {} {} {}"'


def shift(x, y=0, z=0):
    return SHIFT.format(x, y, z)


def mesh(key=1, more="", content=MESH):
    return f'<object id="{key}" {more}>{content}</object>'


def group(key, *components, more=""):
    """Return an object of components, which are `(objectid, attributes)`."""
    listed = "".join(f'<component objectid="{each}" {words}/>' for each, words in components)
    return f'<object id="{key}" {more}><components>{listed}</components></object>'


def model(objects, items='<item objectid="1"/>', more=""):
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<model xmlns="{CORE}" xmlns:p="{PRODUCTION}" '
        f"{more}><resources>{objects}</resources><build>{items}</build></model>"
    )


def archive(content=None, packing=zipfile.ZIP_DEFLATED, links=LINKS, **parts):
    """Return an archive with a model, links to it, and more parts."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", packing) as file:
        if links is not None:
            file.writestr("_rels/.rels", links)
        file.writestr("3D/3dmodel.model", model(mesh()) if content is None else content)
        for name, text in parts.items():
            file.writestr(f"3D/{name}.model", text)
    return stream.getvalue()


#: An assembly of every kind of placement.
ASSEMBLY = model(
    mesh(1, 'name="plate"') + group(2, ("1", ""), ("1", shift(5)), more='name="pair"'),
    f'<item objectid="2" {shift(0, 10)}/><item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>',
)
BY_PATH = archive(
    model(group(2, ("1", 'p:path="/3D/other.model"')), '<item objectid="2"/>'),
    other=model(mesh(), ""),
)
THREEMF_SEEDS = [
    archive(),
    archive(ASSEMBLY, zipfile.ZIP_STORED),
    archive(ASSEMBLY),
    BY_PATH,
]
