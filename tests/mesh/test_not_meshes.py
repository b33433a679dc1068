"""Files that are no meshes: one error says what a file is and what to do, whatever its name."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import re
import tarfile
import zipfile

import pytest

from obbcli.errors import MeshError
from obbcli.mesh import known_suffixes, load_mesh, load_mesh_bytes
from obbcli.mesh.formats import not_meshes
from obbcli.mesh.formats.sniff import beginning

OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
OFF = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
LFS = (
    b"version https://git-lfs.github.com/spec/v1\n"
    b"oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n"
)
#: Words that only Python or a library would say.
INSIDES = re.compile(r"Error|Exception|Traceback|Errno|codec|\bchar \d|<class|invalid literal")


def zipped(name="part.obj"):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(name, OBJ)
    return stream.getvalue()


def tarred():
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w") as archive:
        member = tarfile.TarInfo("part.obj")
        member.size = len(OBJ)
        archive.addfile(member, io.BytesIO(OBJ))
    return stream.getvalue()


PAGE = b"<!DOCTYPE html>\n<html><head><title>Sign in</title></head><body>v 0 0 0</body></html>\n"
OTHERS = {
    "lfs": (LFS, r'is a Git LFS pointer, not the file that it stands for; run "git lfs pull"'),
    "lfs with extensions": (
        LFS.replace(b"oid", b"ext-0-foo sha256:00\noid"),
        'is a Git LFS pointer, .*; run "git lfs pull" where it was cloned',
    ),
    "annex": (
        b"/annex/objects/MD5-s12--0123\n",
        r'is a pointer of git-annex, .*; run "git annex get"',
    ),
    "page": (PAGE, r"is a web page \(HTML\), not a mesh; the download brought something else"),
    "page with a mark": (b"\xef\xbb\xbf\r\n" + PAGE, "is a web page"),
    "xhtml": (b"<?xml version='1.0'?>\n<!-- x -->\n<html xmlns='a'>", "is a web page"),
    "server": (
        b"<?xml version='1.0'?>\n<Error><Code>AccessDenied</Code></Error>",
        "is an error that a web server gave",
    ),
    "not found": (b"404: Not Found", "is what a web server said"),
    "zip": (zipped(), "is a zip archive, not a mesh; unpack it and name the mesh inside"),
    "gzip twice": (
        gzip.compress(gzip.compress(OBJ, mtime=0), mtime=0),
        "is a gzip archive, not a mesh; unpack it",
    ),
    "bzip2": (bz2.compress(OBJ), "is a bzip2 archive"),
    "xz": (lzma.compress(OBJ), "is an xz archive"),
    "tar": (tarred(), "is a tar archive"),
    "7z": (b"7z\xbc\xaf\x27\x1c\0\4" + bytes(40), "is a 7z archive"),
    "png": (b"\x89PNG\r\n\x1a\n" + bytes(40), "is a PNG picture, not a mesh; export the shape"),
    "jpeg": (b"\xff\xd8\xff\xe0" + bytes(40), "is a JPEG picture"),
    "pdf": (b"%PDF-1.7\n", "is a PDF document"),
    "ifc": (b"ISO-10303-21;\nFILE_SCHEMA(('IFC4'));", "is an IFC model of a building, not a mesh"),
    "hdf5": (b"\x89HDF\r\n\x1a\n", "is an HDF5 file, which is not read"),
    "fbx": (b"Kaydara FBX Binary  \0\x1a\0", "is an FBX scene, not a mesh; export it as glTF"),
    "mtl": (b"# x\n\nnewmtl red\nKd 1 0 0\n", "is a library of materials, which belongs to an OBJ"),
    "dwg": (b"AC1032\0\0\0\0", "is a DWG drawing, not a mesh"),
    "zeros": (bytes(5000), "holds nothing but zeros, not a mesh; copy or download it again"),
    "blank": (b" \n\t\r\n" * 2000, "holds nothing but white space"),
    "empty": (b"", "is empty, expected a mesh; write the file again"),
}


@pytest.mark.parametrize(("data", "fault"), OTHERS.values(), ids=OTHERS)
def test_what_is_no_mesh_is_told_whatever_its_name(tmp_path, data, fault):
    for suffix in [*known_suffixes(), ".txt", ""]:
        path = tmp_path / f"part{suffix}"
        path.write_bytes(data)

        with pytest.raises(MeshError, match=fault) as told:
            load_mesh(path)

        assert str(told.value).startswith(f"{path}: ")
        assert not INSIDES.search(str(told.value))


@pytest.mark.parametrize(("data", "fault"), OTHERS.values(), ids=OTHERS)
def test_what_is_no_mesh_is_told_of_a_stream(data, fault):
    with pytest.raises(MeshError, match=f"^<stdin>: {fault}"):
        load_mesh_bytes(data)


@pytest.mark.parametrize("number", range(len(not_meshes._SIGNATURES)))
def test_every_signature_is_needed(number, monkeypatch):
    at, signature, what, remedy = not_meshes._SIGNATURES[number]
    data = bytes([1]) * at + signature + bytes([1]) * 400
    assert not_meshes.not_a_mesh(data) == (f"is {what}, not a mesh", remedy)

    rest = [row for k, row in enumerate(not_meshes._SIGNATURES) if k != number]
    monkeypatch.setattr(not_meshes, "_SIGNATURES", rest)
    assert not_meshes.not_a_mesh(data) is None


@pytest.mark.parametrize(("what", "suffixes"), not_meshes._OWN.items())
def test_formats_with_readers_of_their_own_are_left_to_them(what, suffixes):
    samples = {
        "a zip archive": zipped(),
        "an X3D scene": b"<X3D ",
        "a USD scene": b"#usda 1.0",
    }
    data = samples[what]

    assert not_meshes.not_a_mesh(data).fault.startswith(f"is {what}")
    for suffix in suffixes:
        assert not_meshes.not_a_mesh(data, suffix) is None


def test_a_file_without_a_known_suffix_is_refused_by_its_beginning_alone(tmp_path, monkeypatch):
    path = tmp_path / "film.mkv"
    path.write_bytes(b"\x1a\x45\xdf\xa3" + bytes(1 << 17))
    monkeypatch.setattr("pathlib.Path.read_bytes", None)

    with pytest.raises(MeshError, match=r"unknown mesh suffix '.mkv'; known are"):
        load_mesh(path)


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("part.stl", OFF, "an OFF file"),
        ("part.txt", OFF, "an OFF file"),
        ("part", b"\xef\xbb\xbf" + OFF, "an OFF file"),
        (
            "part.obj",
            b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
            b"endloop\nendfacet\nendsolid a\n",
            "an ASCII STL file",
        ),
        ("part.ply", bytes(80) + b"\1\0\0\0" + bytes(50), "a binary STL file"),
    ],
)
def test_a_mesh_with_another_name_is_read_as_what_it_is_and_told(tmp_path, name, data, words):
    path = tmp_path / name
    path.write_bytes(data)

    mesh = load_mesh(path)

    assert mesh.triangles.tolist() == [[0, 1, 2]]
    assert mesh.notes == (f"is {words} by its content, and is read as such",)


@pytest.mark.parametrize(
    "data", [b"PLY LAYUP OF A WING\n1 2 3\n", b"off we go\n1 2 3\n", b"solid steel\n1 2 3\n"]
)
def test_titles_that_begin_with_a_word_of_another_format_do_not_make_a_file_one(data):
    assert beginning(data) is None


@pytest.mark.parametrize("mark", ["utf-16", "utf-16-be"])
@pytest.mark.parametrize(("suffix", "data"), [(".obj", OBJ), (".off", OFF)])
def test_text_in_utf_16_is_read(mark, suffix, data):
    text = data.decode().encode(mark)
    if mark == "utf-16-be":
        text = b"\xfe\xff" + text

    assert load_mesh_bytes(text, suffix).vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_an_archive_that_is_a_binary_stl_by_its_length_is_read():
    data = b"PK\x03\x04".ljust(80) + b"\1\0\0\0" + bytes(50)

    assert len(load_mesh_bytes(data, ".stl").triangles) == 1


@pytest.mark.parametrize("line", [b"\n", b" ", b"#\n", b"\t\n \n"])
def test_long_beginnings_without_words_take_no_long_time(line):
    # A pattern that goes back and forth over them would take minutes.
    with pytest.raises(MeshError):
        load_mesh_bytes(line * 40_000 + b"x", ".obj")
