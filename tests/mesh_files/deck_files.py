"""Files of finite elements as no library writes them: with all that our own readers take."""

from __future__ import annotations

ASSEMBLY = b"""** an assembly
*HEADING
title
*PART, NAME="Part A"
*SYSTEM
0, 0, 1, 1, 0, 1
0, 1, 1
*NODE, NSET=all
1, 0., 0., 0.
2, 1., 0.
3, 0., 1.D0, 0.
4, 0., 0., 1., 0., 0., 1.
*NODE, SYSTEM=C
5, 1., 45., 0.5
*ELEMENT, TYPE=C3D4, ELSET=solid
1, 1, 2, 3, 4
*ELEMENT, TYPE=S3
2, 1, 2,
5
*SOLID SECTION, ELSET=solid
,
*END PART
*ASSEMBLY, NAME=a
*INSTANCE, NAME=one, PART="part a"
*END INSTANCE
*INSTANCE, NAME=two, PART=Part A
1., 2., 3.
0., 0., 0., 0., 0., 1., 30.
*END INSTANCE
*END ASSEMBLY
*STEP
*STATIC
*END STEP
"""
GENERATED = b"""*NODE
1, 0, 0
5, 4, 0
101, 0, 2
105, 4, 2
*NGEN, NSET=low
1, 5
*NGEN, NSET=high
101, 105, 1
*NSET, NSET=both, GENERATE
1, 5, 4
*NFILL
low, high, 2, 50
*NCOPY, CHANGE NUMBER=1000, OLD SET=low, NEW SET=copy, SHIFT
0, 0, 3
*ELEMENT, TYPE=S4R, ELSET=first
1, 1, 2, 52, 51
*ELGEN, ELSET=sheet
1, 4, 1, 1, 2, 50, 10
*ELCOPY, OLD SET=first, ELEMENT SHIFT=100, SHIFT NODES=1
"""
TECPLOT = b"""TITLE = "zones" # all kinds
VARIABLES = "X", "Y [m]" Z, "p"
ZONE T="a", N=4, E=2, DATAPACKING=BLOCK, ZONETYPE=FETRIANGLE, VARLOCATION=([4]=CELLCENTERED)
0 1 1 0 2*0 2*1 4*0.5 nan 1
1 2 3 1 3 4
ZONE T="b", N=4, E=2, F=FEBLOCK, ET=TRIANGLE, VARSHARELIST=([1-2]=1), CONNECTIVITYSHAREZONE=1
7 7 7 7 0 0 0 0
ZONE I=2, J=2, F=POINT, AUXDATA k="v", STRANDID=1, SOLUTIONTIME=0.5
0, 0, 0, 0
1, 0, 0, 0
0, 1, 0, 0
1, 1, 0, 0
ZONE I=2, J=2, K=2, F=POINT, PASSIVEVARLIST=[4]
0 0 0 1 0 0 0 1 0 1 1 0
0 0 1 1 0 1 0 1 1 1 1 1
GEOMETRY T=LINE
1
2
0 0
1 1
"""
SU2 = b"""NZONE= 2
IZONE= 1
NDIME= 2 % flat
NELEM= 2
5 0 1 2 0
9 0 1 2 3 1
NPOIN= 4
0 0 0
1 0 1
1 1 2
0 1 3
NMARK= 1
MARKER_TAG= low
MARKER_ELEMS= 1
3 0 1
IZONE= 2
NDIME= 3
NELEM= 1
14 0 1 2 3 4
NPOIN= 5
0 0 0
1 0 0
1 1 0
0 1 0
0.5 0.5 1
NMARK= 0
FFD_CORNER_POINTS= 1
0 0 0
"""
UCD = b"""# cells of all types
9 6 1 0 0
0 0 0 0
1 1 0 0
2 1 1 0
3 0 1 0
4 0 0 1
5 1 0 1
6 1 1 1
7 0 1 1
8 0.5 0.5 2
1 1 hex 4 5 6 7 0 1 2 3
2 1 pyr 8 4 5 6 7
3 1 quad 0 1 2 3
4 1 tri 0 1 8
5 1 line 0 8
6 1 prism 0 1 3 4 5 7
1 1
p, Pa
0 1.0
"""

#: By suffix.
DECKS = [
    (".inp", ASSEMBLY),
    (".inp", GENERATED),
    (".inp", UCD),
    (".avs", UCD),
    (".dat", TECPLOT),
    (".su2", SU2),
]
