"""Cards of Nastran that are refused, told or passed over, and what guards their lists."""

from __future__ import annotations

import pytest
from mesh_files.nastran_decks import FORMS, TETRA, grids

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.nastran import cards as nastran_cards

AXISYMMETRIC = (
    *("CTRIAX", "CTRIAX6", "CTRAX3", "CTRAX6", "CQUADX", "CQUADX4", "CQUADX8", "CCONEAX"),
    *("CTAXI", "CQAXI"),
)


def load(deck: str):
    return load_mesh_bytes(deck.encode("ascii"), ".bdf")


def refused(deck: str) -> str:
    with pytest.raises(MeshError) as caught:
        load(deck)
    return str(caught.value)


@pytest.mark.parametrize(
    ("card", "fault"),
    [
        *((f"{name},9,1,1,2,3", f"{name} is axisymmetric") for name in AXISYMMETRIC),
        ("CAABSF,9,1,1,2,3", "CAABSF is an acoustic element"),
        ("CHACAB,9,1,1,2,3", "CHACAB is an acoustic element"),
        ("CQUAD1,9,1,1,2,3,4", "CQUAD1 is an element of older programs"),
        ("CIHEX2,9,1,1,2,3,4", "CIHEX2 is an element of older programs"),
        ("CIFHEX,9,1,1,2,3,4", "CIFHEX is a cohesive element"),
        ("SELOC,1,1,2,3,1,2,3", "SELOC places or mirrors a copy"),
        ("SEMPLN,1,PLANE,1,2,3", "SEMPLN places or mirrors a copy"),
        ("CSUPER,2,1,1,2,3", "CSUPER places or mirrors a copy"),
        ("MDLOC,2,1", "MDLOC places or mirrors a copy"),
        ("CSUPEXT,2,1", "CSUPEXT stands for an external superelement"),
        ("SEBULK,2,MIRROR,1", "SEBULK makes a superelement of type MIRROR"),
        ("SEBULK  2       EXTERNAL", "SEBULK makes a superelement of type EXTERNAL"),
        ("BCPATCH,1", "BCPATCH is a rigid contact surface"),
        ("BCBODY,1,3D,RIGID,,\n+,NURBS,-4,5", "BCBODY describes a rigid surface"),
        ("=,*1,=", "= repeats fields of the card before it"),
        ("=3", "=3 repeats fields of the card before it"),
        ("/,5,9", "/ deletes cards of another run"),
        ("/       5       9", "/ deletes cards of another run"),
        ("MESH,1,BOX", "MESH makes a mesh or a shape of its own"),
        ("CWHAT,1,1,2,3", "CWHAT is no card that is known here, and it could make surface"),
        ("NEWSURF,1", "NEWSURF is no card that is known here"),
        ("1,2,3", "1 is no card that is known here"),
    ],
)
def test_cards_that_could_make_surface_are_refused_by_name_and_line(card, fault):
    text = refused(f"{TETRA}{card}\nENDDATA\n")

    assert text.startswith(f"<stdin>:6: {fault}")
    assert "; " in text  # the remedy


@pytest.mark.parametrize(
    "card",
    [
        *("SPOINT,5,THRU,9", "PSOLID,1,1", "MAT1,1,1.+7,,.3", "MATHP,1"),
        *("FORCE,1,2,0,1.,1.", "RBE2,9,1,123,2,3", "RBE3,9", "CBUSH,9,1,1,2"),
        *("CELAS2,9,1.,1", "CONM2,9,1,0,1.", "SET1,1,2", "SPC1,1,123,2", "PLOAD4,1,1,1."),
        *("PLOTEL,1,1,2", "EIGRL,1,,,9", "PARAM,POST,-1", "CWELD,9"),
        *("BCBODY,1,3D,DEFORM,3", "BSURF,3,1", "SEBULK,1,PRIMARY", "SECONCT,1", "DMIG,A,0"),
        *("CORD3G,1", "AERO,1", "AESURF,1", "SPLINE1,1", "DESVAR,1", "DRESP1,1"),
        *("TABLED1,1\n+,0.,0.,ENDT", "PVAL,1", "DEQATN  1       F(A)=A+1,\n        2"),
        *("CGAP,9,1,1,2", "TEMP,1,2,3.", "FREQ1,1", "RADM,1", "ply,1"),
    ],
)  # fmt: skip
def test_cards_without_surface_change_nothing(card):
    plain = load(TETRA)

    mesh = load(f"{card}\n{TETRA}{card.replace('9', '8')}\n")

    assert mesh.vertices.tolist() == plain.vertices.tolist()
    assert mesh.triangles.tolist() == plain.triangles.tolist()
    assert mesh.notes == plain.notes


def test_the_lists_are_apart():
    read = {*nastran_cards.ELEMENTS, *nastran_cards.BY_GRIDS, *nastran_cards.BY_POINTS}
    lists = read, set(nastran_cards.REFUSED), set(nastran_cards.TOLD), set(nastran_cards.PASSED)

    assert sum(map(len, lists)) == len(set().union(*lists))
    for names in lists[:3]:
        assert not [name for name in names if nastran_cards.is_passed_over(name)]


@pytest.mark.parametrize("name", sorted(nastran_cards.ELEMENTS))
def test_an_element_that_is_on_no_list_is_refused_not_dropped(name, monkeypatch):
    count = len(nastran_cards.ELEMENTS[name].nodes)
    fields = ",".join(str(node) for node in range(1, 7))
    more = "".join(f"\n+,{7 + k}" if k % 8 == 0 else f",{7 + k}" for k in range(count - 6))
    deck = grids([(k, k * k, k**3) for k in range(20)]) + f"{name.decode()},1,1,{fields}{more}\n"
    assert len(load(deck).triangles) > 0
    shorter = {key: value for key, value in nastran_cards.ELEMENTS.items() if key != name}

    monkeypatch.setattr(nastran_cards, "ELEMENTS", shorter)

    assert f"{name.decode()} is no card that is known here" in refused(TETRA_BESIDE + deck)


TETRA_BESIDE = "$ the deck holds other surface as well\n"


@pytest.mark.parametrize("card", ["SELOC,1", "CHACAB,1,1,2"])
def test_a_card_that_is_taken_off_the_list_of_refused_ones_is_still_refused(card, monkeypatch):
    name = card.partition(",")[0]
    monkeypatch.delitem(nastran_cards.REFUSED, name.encode())

    assert f"{name} is no card that is known here" in refused(f"{TETRA}{card}\n")


def test_a_card_that_is_taken_off_the_list_of_passed_ones_is_refused(monkeypatch):
    assert load(TETRA + "FORCE,1,2\n")

    monkeypatch.setattr(nastran_cards, "PASSED", nastran_cards.PASSED - {b"FORCE"})

    assert "FORCE is no card that is known here" in refused(f"{TETRA}FORCE,1,2\n")


@pytest.mark.parametrize(
    ("deck", "fault"),
    [
        (f" {TETRA}", r"<stdin>:1: continues a card, but none stands before it"),
        (f"BEGIN BULK\n+,1\n{TETRA}", r"<stdin>:2: continues a card, but none stands before it"),
        (
            f"{TETRA} CTRIA3,1,1,1,2,3\n",
            r"<stdin>:6: begins with blanks, so that CTRIA3 would continue the line before it",
        ),
        (
            f"{TETRA}   CTRIA3  1       1       1       2\n",
            r"<stdin>:6: begins with blanks, so that CTRIA3 would continue",
        ),
        (
            f"{TETRA}CTRIA3 2       1       1       2       3\n".replace("CTRIA3 2", "CTRIA3 2 "),
            r"<stdin>:6: has 'CTRIA3 2' in its first eight columns, expected CTRIA3; put",
        ),
        (
            f"{TETRA}CTRIA3,2,1,1,2,3,,,,4\n",
            r"<stdin>:6: has '4' behind its 8 fields; put it on a line of its own",
        ),
        (
            f"{TETRA}CQUAD8  2       1       1       2       3       4\n        1       2,\n",
            r"<stdin>:7: has '1       2' before its first comma, expected one name or none",
        ),
        (f"{TETRA}CQUAD8,2,1,1,2,3,4\n  1,2\n", r"<stdin>:7: has '1' before its first comma"),
        (f"{TETRA}GRID*,9,,1.,2.,3.\n", r"<stdin>:6: has '3.' behind its 4 fields"),
        (
            f"{TETRA}GRID*   9                               1.              2.\n        3.\n",
            r"<stdin>:7: continues a line of large fields in small ones; begin it with \*",
        ),
        (
            f"{TETRA}GRID*,9,,1.,2.\n,3.\n",
            r"<stdin>:7: continues a line of large fields in small ones",
        ),
        (
            "CTETRA  1       1       1       2       3       4                       +A\n"
            "GRID    9                                                               +B\n"
            "+A      5\n" + TETRA,
            r"<stdin>:3: 'A' continues another line than the one before it; sort the deck",
        ),
        (
            "CTETRA  1       1       1       2       3       4                       +A\n"
            f"GRID    9\n+A      5\n{TETRA}",
            r"<stdin>:3: 'A' continues another line than the one before it",
        ),
        (
            f"CEND\n{TETRA}",
            r"<stdin>:1: CEND ends the executive control, but no BEGIN BULK follows",
        ),
        (f"BEGIN BULK\nBEGIN BULK\n{TETRA}", r"<stdin>:2: 'BEGIN BULK' stands here a second time"),
        (f"BEGIN SUPER=1\nBEGIN SUPER = 1\n{TETRA}", r":2: 'BEGIN SUPER=1' stands here a second"),
        (
            f"BEGIN BULK\n{TETRA}BEGIN AUXMODEL=3\n{TETRA}",
            r"<stdin>:7: 'BEGIN AUXMODEL 3' begins something else than bulk data",
        ),
        (f"BEGIN MODULE=3\n{TETRA}", r"<stdin>:1: 'BEGIN MODULE 3' begins something else"),
        (
            f"RESTART VERSION=1\nCEND\nBEGIN BULK\n{TETRA}",
            r"<stdin>:1: RESTART takes the rest of the model from another run's database",
        ),
        ("GRID,1\n\0GRID,2\n", r"<stdin>:2: holds a NUL byte, which no text does"),
        ("$ nothing\n", r"<stdin>: has no surface, .* its cards are none at all"),
    ],
)
def test_decks_that_are_not_what_they_should_be_are_refused(deck, fault):
    with pytest.raises(MeshError, match=fault):
        load(deck)


def test_a_name_in_front_of_another_lines_continuation_needs_no_match_where_none_is_given():
    # Programs that write no name behind a line still number the line that continues it.
    deck = FORMS["continued"].replace("2+T1", "2").replace("*T1 ", "*9  ")

    assert len(load(deck).triangles) == 4
