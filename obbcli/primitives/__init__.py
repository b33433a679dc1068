"""Pairs of boxes and triangles, still or moving: Eberly's pair questions one by one.

`intersects` says whether two shapes meet in `[0, duration]`, `first_contact` when, where and how
first. Shapes are closed and taken literally; touching counts, and so does contact at 0 and at the
duration. Both answers are exact for the doubles given: where rounding could decide, integers do.
Shapes, velocities and durations come one each or as arrays of N; one goes with all of N.

Guarantee: no verdict is ever a matter of rounding, from subnormals to the largest doubles; times
are the doubles nearest to the exact ones. Boxes need axes orthonormal to 1e-9, of either hand.

Source: D. Eberly, Dynamic Collision Detection using Oriented Bounding Boxes (2008), sections 2 to
4. Instead of asking whether one axis separates for the whole time, each axis of the shapes at rest
bounds the time of contact from below and above; contact is where all agree. That needs none of
the paper's axes W x A, gives first and last time at once, and holds for flat boxes, segments and
points: coplanar triangles take the axes of Table 6, and lower ranks the like.

Readers of the paper will want the errata of those sections (numbers as the tests name them; on
the right what holds, and is used or tested here):

===  ===================  =========================================================================
2    section 1            the separating plane is parallel to an edge of each, not through it
4    section 2            extents a_i > 0, right-handed axes: 0 and left-handed are as good
5    section 2.1          ProjDist of the second box is that of C_1 + ...; K_1 = L.D / L.L
6    Table 1, last row    A_2 x B_1 a second time: A_2 x B_2
7    2.2.2                W = V_1 - V_0 is the second velocity less the first; D_1 = D(T)
8    2.2.2                boxes meet where projections along W do: only together with the 15 axes
9    2.3.1, 3.3.1, 4.3.1  the last entry is the first contact: only if no exit comes before it
10   equation (4)         sum over j of |c_ij| (b_j + sigma Sign(c_ij) y_j)
11   equation (5)         last term b_i + sigma y_i
12   2.3.2, faces         coordinates chosen one by one leave the other box: clip the faces
13   2.3.2, edges         second term has x_i2
14   2.3.2, edges         its sign, where terms are grouped, is Sign(i2, i0)
15   2.3.2, edges         the four c_ij must be nonzero, not zero
16   Table 2, row B_i     x_j = sigma Sign(c_ji) a_j
17   3.2.1                max(p, p + d) < -R
18   3.2.2                needs the 6 axes W x A_i and W x E_j as well
19   equation (8)         D = (U_0 + T V_1) - (C + T V_0), V_0 the box's velocity
20   3.3.2, N             free coordinates as 12; y_0 + y_1 <= 1 holds as well
21   3.3.2, A_i           third case keeps y_0 = 0
22   3.3.2, A_i x E_j     R uses E_j0
23   Tables 4b to 4d      x_i can be 0 / 0: solve the two lines, over |A_i x E_j|^2
24   4.2                  11 axes let coplanar disjoint triangles meet: Table 6 has the others
25   4.2.1, E x F         min(q, q + d)
26   4.2.2                needs W x E_i and W x F_j as well
27   4.2.2, axis M        the single projection moves: -w, or the roles swapped
28   4.3.2, y_j           the term is -M.(D x F_1-j)
29   4.3.2, M             third case has sigma M.E_1 >= 0, and is equation (26)
30   4.3.2, E x F         first case has N.F_j0
31   4.3.2                free coordinates as 12
32   Table 7, row M       sigma p_k = max_k(sigma p_k)
===  ===================  =========================================================================
"""

from obbcli.primitives.contacts import PrimitiveContact, PrimitiveContacts, SeparatingAxis
from obbcli.primitives.questions import first_contact, intersects
from obbcli.primitives.shapes import Obb, Triangle

__all__ = [
    "Obb",
    "PrimitiveContact",
    "PrimitiveContacts",
    "SeparatingAxis",
    "Triangle",
    "first_contact",
    "intersects",
]
