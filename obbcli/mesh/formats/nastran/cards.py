"""Which cards of Nastran make surface, and what becomes of all others: the one place for the lists.

Names are those of MSC Nastran, Simcenter (NX) Nastran, Autodesk Nastran, OptiStruct and MYSTRAN.
A card that is on none of the lists is refused: it could make, place or scale surface.
"""

from __future__ import annotations

from typing import NamedTuple


class Element(NamedTuple):
    """Says where an element's card has its nodes; fields are counted from 0 behind the name.

    Args:
        cell: the shape by its corners, as VTK calls it.
        corners: how many corners it has, which all must be there.
        nodes: fields of the corners, then of the middle nodes in VTK's order, which may be blank.
        offset: field of a shell's offset from its GRIDs; None where it has none.
    """

    cell: str
    corners: int
    nodes: tuple[int, ...]
    offset: int | None = None

    @property
    def node_counts(self) -> tuple[int, ...]:
        """Return how many nodes the types of cells have that it can be: corners alone, or more."""
        more = (8, 9) if self.cell == "quad" else (len(self.nodes),)
        return self.corners, *(count for count in more if self.corners < count <= len(self.nodes))


def _nodes(count: int) -> tuple[int, ...]:
    return tuple(range(2, 2 + count))


#: Nastran numbers the middle nodes of a solid's upright edges before those of its top, VTK behind.
_WEDGE = (*range(2, 8), 8, 9, 10, 14, 15, 16, 11, 12, 13)
_BRICK = (*range(2, 10), 10, 11, 12, 13, 18, 19, 20, 21, 14, 15, 16, 17)

_TRIANGLE = Element("triangle", 3, _nodes(3), 6)
_TRIANGLE_6 = Element("triangle", 3, _nodes(6), 9)
_QUAD = Element("quad", 4, _nodes(4), 7)
_QUAD_8 = Element("quad", 4, _nodes(8), 15)

#: The elements that are read: shells, membranes, plane sections, solids.
ELEMENTS = {
    b"CTRIA3": _TRIANGLE,
    b"CTRIAR": _TRIANGLE,
    b"CTRIA6": _TRIANGLE_6,
    b"CQUAD4": _QUAD,
    b"CQUADR": _QUAD,
    b"CQUAD8": _QUAD_8,
    b"CQUAD": Element("quad", 4, _nodes(9)),
    b"CSHEAR": Element("quad", 4, _nodes(4)),
    b"CPLSTN3": Element("triangle", 3, _nodes(3)),
    b"CPLSTS3": Element("triangle", 3, _nodes(3)),
    b"CPLSTN4": Element("quad", 4, _nodes(4)),
    b"CPLSTS4": Element("quad", 4, _nodes(4)),
    b"CPLSTN6": Element("triangle", 3, _nodes(6)),
    b"CPLSTS6": Element("triangle", 3, _nodes(6)),
    b"CPLSTN8": Element("quad", 4, _nodes(8)),
    b"CPLSTS8": Element("quad", 4, _nodes(8)),
    b"CTPSTN": Element("triangle", 3, _nodes(6)),
    b"CQPSTN": Element("quad", 4, _nodes(8)),
    b"CTETRA": Element("tetra", 4, _nodes(10)),
    b"CPYRAM": Element("pyramid", 5, _nodes(13)),
    b"CPYRA": Element("pyramid", 5, _nodes(13)),
    b"CPENTA": Element("wedge", 6, _WEDGE),
    b"CHEXA": Element("hexahedron", 8, _BRICK),
    # Gaskets have no middle nodes on the edges between their two faces.
    b"CGASK6": Element("wedge", 6, _nodes(6)),
    b"CGASK8": Element("hexahedron", 8, _nodes(8)),
    b"CGASK12": Element("wedge", 6, _nodes(12)),
    b"CGASK16": Element("hexahedron", 8, _nodes(20)),
}

GRID, GRID_DEFAULTS = b"GRID", b"GRDSET"
#: Coordinate systems by three GRIDs, and by three points of another system.
BY_GRIDS = {b"CORD1R": "R", b"CORD1C": "C", b"CORD1S": "S"}
BY_POINTS = {b"CORD2R": "R", b"CORD2C": "C", b"CORD2S": "S"}

#: Systems of other kinds: no harm is done unless a GRID stands in one.
OTHER_SYSTEMS = frozenset((b"CORD3G", b"CORD3R", b"CORD4R", b"CORD5R"))

_AXISYMMETRIC = "is axisymmetric: the deck holds a section of a body of revolution, not its surface"
_ACOUSTIC = "is an acoustic element whose surface is not read"
_OLD = "is an element of older programs whose surface is not read"
_COHESIVE = "is a cohesive element between two bodies, whose surface is not read"
_COPY = "places or mirrors a copy of a part of the model"
_OTHER_FILE = "stands for an external superelement, whose surface is not in the deck"
_CURVED = "is a rigid contact surface of curves or patches, not of triangles"

#: Cards that make, place or copy surface in a way that is not read, with the reason.
REFUSED = {
    name.encode("ascii"): reason
    for reason, names in {
        _AXISYMMETRIC: "CTRIAX CTRIAX6 CTRAX3 CTRAX6 CQUADX CQUADX4 CQUADX8 CCONEAX CTRIAAX "
        "CTRAPAX CTRIARG CTRAPRG CTORDRG CTAXI CQAXI CAXIF2 CAXIF3 CAXIF4 CIFQDX AXIC AXIF",
        _ACOUSTIC: "CAABSF CHACAB CHACBR CACINF3 CACINF4 CFHEX1 CFHEX2 CFTETRA CFWEDGE "
        "CFLUID2 CFLUID3 CFLUID4 CSLOT3 CSLOT4 CAFLUID CACONV",
        _OLD: "CTRIA1 CTRIA2 CTRMEM CTRIM6 CTRBSC CTRPLT CTRPLT1 CTRSHL CQUAD1 CQUAD2 CQDMEM "
        "CQDMEM1 CQDMEM2 CQDPLT CTWIST CHEXA1 CHEXA2 CIHEX1 CIHEX2 CIHEX3 CWEDGE CIS2D8 CEMLOOP "
        "CRAC2D CRAC3D CDUM1 CDUM2 CDUM3 CDUM4 CDUM5 CDUM6 CDUM7 CDUM8 CDUM9",
        _COHESIVE: "CIFHEX CIFPENT CIFPEN CIFQUAD",
        _COPY: "SELOC SEMPLN CSUPER MDLOC MDMPLN MDROT1 MDROT2 MDTRAN MDBULK RELOC",
        _OTHER_FILE: "CSUPEXT",
        _CURVED: "BCPATCH BCBZIER BCNURB2 BCNURBS BCRGSRF BCTRIM",
        "makes a mesh or a shape of its own": "MESH SHAPE SPHERE CYLINDR BOX GENINT GENGRID EGRID "
        "PRIM1 PRIM2 PRIM3 PRIM4 PRIM5 PRIM6 PRIM7 PRIM8 FEMODEL",
        "repeats fields of the card before it": "=",
        "deletes cards of another run": "/",
    }.items()
    for name in names.split()
}

#: Cards that are passed over with a note: bodies or changes of surface that are not taken. `{}` is
#: how many cards of which name.
TOLD = {
    name.encode("ascii"): words
    for words, names in {
        "{} without surface passed over: bars and beams are lines": "CBAR CBEAM CBEAM3 CBEND CROD "
        "CONROD CTUBE",
        "{} passed over: aerodynamic panels are no structure": "CAERO1 CAERO2 CAERO3 CAERO4 CAERO5 "
        "CAERO7 BODY7",
        "{} passed over: they bound heat, not bodies": "CHBDYE CHBDYG CHBDYP",
        "{} passed over: they serve plots alone": "PLOTEL3 PLOTEL4 PLOTEL6 PLOTEL8 PLOTHEX PLOTPEN "
        "PLOTPYR PLOTTET PLOTQUD PLOTTRI",
        "{} not applied: curved edges and faces of p-elements are taken as flat": "GMCURV GMSURF "
        "FEEDGE FEFACE GMNURB",
        "{} not applied: GRIDs are taken without imperfections": "IMPERF IMPGEOM",
        "{} not applied: of a cyclic structure the deck holds one segment": "CYSYM CYJOIN",
        "thickness of {} not applied: shells are taken at their GRIDs": "PSHELL PCOMP PCOMPG "
        "PCOMPLS PSHEAR",
    }.items()
    for name in names.split()
}

#: Cards without surface, by what they are about.
_PASSED = {
    "points and their freedoms": (
        "BDYLIST EPOINT FLSYM FREEPT FSLIST GRIDA GRIDB GRIDF GRIDG GRIDS GRIDU MICPNT PANEL "
        "POINT POINTAX POINTS PRESPT RINGAX RINGFL SECTAX SEQGP SLBDY SNORM SPOINT"
    ),
    "scalar elements, masses, connectors": (
        "BAROR BEAMOR CACCEL CBARAO CBEAR CBUSH CBUSH1D CBUSH2D CBUSHT CBUTT CCOMB CCRSFIL CDAMP1 "
        "CDAMP2 CDAMP3 CDAMP4 CDAMP5 CELAS1 CELAS2 CELAS2F CELAS3 CELAS4 CELAS4F CELAS5 CELAS6 "
        "CELL CFAST CFILLET CGAP CGAPG CINTC CJOINT CMARKB2 CMARKN1 CMASS1 CMASS2 CMASS3 CMASS4 "
        "CMBEAM CMSPDP CONCTL CONM1 CONM2 CONM3 CSEAM CSMADD CSMSET CSPOT CSPR CVISC CWELD GENEL "
        "GRNDSPR MASSSET PLOTEL RBJOINT RBJSTIFF"
    ),
    "rigid elements": (
        "CLRNC CNTITF GROUND JOINTG RBADD RBAR RBAR1 RBAX3D RBE1 RBE2 RBE2A RBE2D RBE2F RBE2GS "
        "RBE3 RBE3D RBODY RCONN RIGID RJOINT RLOAD RROD RSPLINE RSSCON RTRPLT RTRPLT1 RWELD TIE"
    ),
    "properties": (
        "DTEMP ICE MSTACK NSM NSM1 NSMADD NSML NSML1 PAABSF PACABS PACBAR PACINF PACTIVE PAERO1 "
        "PAERO2 PAERO3 PAERO4 PAERO5 PAXISYM PAXSYMH PBAR PBARL PBARN1 PBARST PBCOMP PBDISCR "
        "PBEAM PBEAM3 PBEAM71 PBEAML PBEAR PBEMN1 PBEND PBMARB6 PBMNUM6 PBMSECT PBRSECT PBSH2DT "
        "PBSPCR PBUSH PBUSH1D PBUSH2D PBUSHT PBUTT PCAFL PCOHE PCOMB PCOMPF PCOMPFQ PCOMPG1 "
        "PCOMPP PCOMPS PCONEAX PCONT PCONTHT PCONTX PCONV PCONVM PCRSFIL PDAMP PDAMP5 PDAMPT "
        "PDISTB PEDGE PELAS PELAST PERMEAB PFACE PFAST PFASTT PFAT PFILLET PFPANEL PFTG PGAP "
        "PGAPHT PGASK PGPLSF PHBDY PHYB PIHEX PINTC PINTS PISHELL PJOINT PJOINT2 PJOINTG PLCOMP "
        "PLCYISO PLCYKIN PLCYRUP PLOTG PLPLANE PLSOLID PLY PMARKER PMASS PMIC PMREBAI PMREBAR "
        "PPLANE PQUAD1 PRAC2D PRAC3D PRESAX PROD PRODN1 PROPBCK PSEAM PSEC PSHEARN PSHELL1 "
        "PSHELLD PSHL3D PSHLN1 PSHLN2 PSLDN1 PSLDN2 PSOLCZ PSOLID PSOLIDD PSPOT PSPRMAT PSTRAIN "
        "PSURF PTHPAD PTRSHL PTUBE PVISC PWELD PWELD1 PWSEAM SEAM SMCORE STACK SWLDPRM THPAD "
        "UNITS"
    ),
    "materials and tables": (
        "BIAS COHFRIC CREEP CRKINIT FAILJNC FAILURE HYBDAMP ISOP MAT* MCOHE MFLUID MGASK MINSTAT "
        "MIXTURE MODOPT MODTRAK MPCREEP MTCREEP MTHERM NXSTRAT SDAMPING TABDMP1 TABDMPI TABL* "
        "TABRND1 TABRNDG TABVE VCCT VISCDATA XDAMP"
    ),
    "loads": (
        "ACCEL ACCEL1 ACCEL2 ACCMETR ACCSSPT ACLOAD ACPLNW ACSRCE ALOAD AMLREG BLDOUT BOLT* CLOAD "
        "CONV CONVDV CONVM DAREA DEFORM DELAY DLDPRM DLOAD DLOADC DPHASE DRPLOAD DTABLE DYPARAM "
        "FAT* FLLWADD FLLWER FORCDST FORCE FORCE1 FORCE2 FORCEAX FORCEDS FTG* GRAV GUST GUST2 "
        "HEATLOS INIT* INLTVEL INVEL INVELB LATTICE LEAKAGE LOAD LOADADD LOADCLID LOADCYH LOADCYN "
        "LOADCYT LOADG LOADOF LOADT LSEQ MOMAX MOMAX1 MOMDIST MOMENT MOMENT1 MOMENT2 MOMNTDS "
        "MOTION MOTN* MPCY NOLIN1 NOLIN2 NOLIN3 NOLIN4 PERBC PLOAD PLOAD1 PLOAD2 PLOAD3 PLOAD4 "
        "PLOAD5 PLOADB3 PLOADE1 PLOADG PLOADX PLOADX1 PRELOAD PRESTRS PRETENS PRETPRM QBDY1 QBDY2 "
        "QBDY3 QBDY4 QHBDY QSET QVECT QVOL RAD* RANDPS RANDT1 RANDVAR RCROSS RCROSSC RESPSPEC "
        "RFORCE RFORCE1 RFORCE2 RFORCE3 RGYRO RLOAD1 RLOAD2 RLOAD3 ROTBENT ROTHYBD ROTORAX ROTORB "
        "ROTORD ROTORG ROTORSE SLOAD SLOADN1 SPCR TEMP* TF THERM TIC* TIM2PSD TIMNAT TIMNVH "
        "TLOAD1 TLOAD2 TLOAD3 TMPSET TRMC UNBALNC USLOAD VEC VIEW VIEW3D VIEWEX WET* XPREL"
    ),
    "constraints and sets": (
        "ACTIVE ALIASM ASET* BNDFIX* BNDFRE* BSET* CSET CSET1 CVSET DEACTEL ELIST ELSET ELSUM "
        "EXTRN GMBC GMBNDC GMCONV GMCORD GMINTC GMINTS GMLOAD GMQVOL GMSPC GROUP MARK MODSET MPC "
        "MPCADD MPCAX MPCD MPCT OMIT OMIT1 OMITAX PSET QSET1 RELEASE RVDOF RVDOF1 SEQEP SET SET1 "
        "SET2 SET3 SET4 SETADD SETGROUP SPC SPC1 SPCADD SPCAX SPCD SPCD2 SPCE SPCG SPCNT SPCOFF "
        "SPCOFF1 SPCP SUPAX SUPORT SUPORT1 SUPORT2 SUPORT6 SUPUP SURF SURFINI UDNAME USET USET1"
    ),
    "contact": (
        "BCAUTOP BCBDPRP BCBMRAD BCBODY BCBODY1 BCBOX BCCRACK BCGM700 BCGRID BCHANGE BCMATL "
        "BCMOVE BCONECT BCONP BCONPRG BCONPRP BCONTACT BCONUDS BCPARA BCPFLG BCPROP* BCRIGID "
        "BCRPARA BCRPARM BCSCAP BCSEG BCSURF BCTABL1 BCTABLE BCTADD BCTPAR2 BCTPARA BCTPARM "
        "BCTSET BEADVAR BEDGE BFRIC BFRLIM BGADD BGPARA BGPARM BGSET BLSEG BLTMPC BOUTPUT BSQUEAL "
        "BSURF BSURFS BWIDTH CNTSTB CONTACT CONTADD CONTG CONTPRM CTRPARM FRIC GAPPRM GLUE MBOLT "
        "MBOLTUS UNGLUE"
    ),
    "superelements": (
        "MDBCNCT MDBKMAT MDBNDRY MDBOLT MDCONCT MDDMIG MDEXCLD MDFAST MDLABEL MDMIAUX MDMIOUT "
        "MDMIR1 MDMIR2 MDMPC MDRBE2 MDRBE3 MDRJNT MDRROD MDSEAM MDWELD MIAUX SEBNDRY SEBSET* "
        "SECONCT SECSET* SEDLINK SEDR SEDRSP2 SEDRSP3 SEDV SEELT SEEXCLD SELABEL SELOAD SENQSET "
        "SEQSEP SEQSET* SESET SESUP SETREE SEUSET*"
    ),
    "aeroelasticity": (
        "ACMODL AE* CAERO6 CSSCHD DIVERG FFT FLFACT FLUTTER GENDMP HINGE MKAERO1 MKAERO2 MLOADS "
        "MON* PAERO7 SPBLND1 SPBLND2 SPLINB SPLINE* SPLINRB TRIM TRIM2 TRIMFLT UXVEC"
    ),
    "solution and output": (
        "ACADAPT ACC ACIFPRM ACORDER ACPEMCP ACTRAD ADAPT ADUMA ATVBULK ATVFS AUTOCON CAMPBLL "
        "CONMOD CONTRLT CYAX CYEXT CYJOINX CYSUP DAMPGBL DAMPING DATAREC DESCRIPT DIAG DSYSPRM "
        "DYNRED EBD* ECHOOFF ECHOON EIG* ENDDYNA ENDT ENTUDS ESE EXTRACT FREQ* IMPCASE IMPRINT "
        "IPSTRAIN ITER KDAMP LABEL LATPRM MARPRN MAXMIN MBSPRM MDLPRM METADATA MPHEAT MPROCS "
        "NHRMPRM NL* NTHICK OUTPUT OUTRCV PARAM PARAMARC PEAKOUT PVAL RESLIST ROTPARM STOCHAS "
        "STPSCL SUBTITLE SWEEP SYSSETTI TABSCT TERMIN TITLE TMCPARA TOLERANCE TSTEP* UDS* USRSUB6 "
        "VATVFS VUGRID XHIST"
    ),
    "matrices and equations": (
        "BLKHDF CDMIG CMSMETH CNVTOL DEQATN DMI* DMNCON DTI ELAR ELAR2 ELARADD ERPPNL EXTSE* "
        "FBALOAD FBAPHAS FBODYLD FBODYSB FRF* K2GG ROMAX"
    ),
    "design": (
        "ASFRAC BALDEF BMFACE BNDGRID DCON* DDVAL DESGLB DESOBJ DESSUB DESVAR DESVARG DGLOBAL "
        "DLATTICE DLINK DLINK1 DLINK2 DMRLAW DOBJREF DOPTPRM DREPADD DREPORT DRESP* DSCONS "
        "DSCREEN DSHAPE DSHUFFLE DSIZE DSYSID DTPG DTPL DV* DWEIGHT ESLTADD ESLTIME MTRDEF STCONS "
        "STMODEL SYMEDGE SYMSURF TOMVAR TOPDMG TOPFILT TOPSTR TOPVAR TPOPT XTPDEN"
    ),
    "multibody": (
        "CPRBODY MBACT MBCNTR MBCRV MBDCRV MBDEACT MBDFRC MBFRC MBFRCE MBFXJNT MBJOINT MBLIN "
        "MBMNT MBMNTE MBPCRV MBPTCV MBREQ MBREQ1 MBREQE MBREQM MBSEQ MBSFRC MBSFRCE MBSIM MBSMNT "
        "MBVAR MRCPRB PFBODY PRBODY"
    ),
    "sections of beams": ("BEGIN CSEC2 CSEC3 CSEC4 CSEC6 CSEC8 DIM END"),
}
_WORDS = [word for names in _PASSED.values() for word in names.split()]
PASSED = frozenset(word.encode("ascii") for word in _WORDS if not word.endswith("*"))
#: Beginnings of names that are passed over, where a whole family of cards has them.
PASSED_FAMILIES = tuple(word[:-1].encode("ascii") for word in _WORDS if word.endswith("*"))

#: The word before a solid's material system, in OptiStruct: no GRID follows.
MATERIAL_SYSTEM = b"CORDM"

#: A superelement that is the part itself; all other types are copies, or stand in other files.
PRIMARY = b"PRIMARY"
SUPERELEMENT = b"SEBULK"
#: Words in a contact body's own card that begin a rigid surface which is no mesh.
CONTACT_BODY = b"BCBODY"
RIGID_SHAPES = (b"PATCH", b"NURBS", b"BEZIER", b"CYLIND", b"SPHERE", b"POLY", b"RULED", b"LINE")


def is_read(name: bytes) -> bool:
    """Return whether the cards of a name are read."""
    return (
        name in ELEMENTS
        or name in (GRID, GRID_DEFAULTS, SUPERELEMENT)
        or name in BY_GRIDS
        or name in BY_POINTS
    )


def is_passed_over(name: bytes) -> bool:
    """Return whether cards of a name have no surface and change none."""
    return name in PASSED or name in OTHER_SYSTEMS or name.startswith(PASSED_FAMILIES)
