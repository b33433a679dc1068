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

Readers of the paper will want its errata (left as printed, right as used and tested here):

==================  ============================================================================
Section 1           separating plane "contains an edge from each": is parallel to an edge of each
Section 2           extents a_i > 0, right-handed axes: 0 and left-handed are as good
Section 2.1         ProjDist of the second box: the argument is C_1 + ..., and K_1 = L.D / L.L
Table 1, last row   A_2 x B_1 a second time: A_2 x B_2
2.2.2               W = V_1 - V_0 subtracts the first velocity from the second; D_1 = D(T)
2.2.2               boxes meet where their projections along W do: only together with the 15 axes
2.3.1, 3.3.1, 4.3.1 the largest entry time is the first contact: only if no exit comes before it
Equation (4)        sum over j of |c_ij| (b_j + sigma Sign(c_ij) y_j)
Equation (5)        last term b_i + sigma y_i
2.3.2, 3.3.2, 4.3.2 free coordinates chosen one by one leave the other shape: clip the faces
2.3.2, edge-edge    second term has x_i2, grouped with Sign(i2, i0); the four c_ij are nonzero
Table 2, row B_i    x_j = sigma Sign(c_ji) a_j
3.2.1               max(p, p + d) < -R
3.2.2               a moving triangle and box need the 6 axes W x A_i, W x E_j as well
Equation (8)        D = (U_0 + T V_1) - (C + T V_0), V_0 the box's velocity
3.3.2, A_i          third case keeps y_0 = 0; A_i x E_j: R uses E_j0
Tables 4b to 4d     x_i over N.(A_i x E_j) can be 0 / 0: solve the two lines, over |A_i x E_j|^2
4.2                 11 axes say that coplanar disjoint triangles meet: Table 6 has theirs
4.2.1, E x F        min(q, q + d)
4.2.2               moving triangles need W x E_i, W x F_j as well; for M the other one moves
4.3.2, y_j          the term is -M.(D x F_1-j); case M: sigma M.E_1 >= 0, equation (26)
4.3.2, E x F        first case N.F_j0
Table 7, M          sigma p_k = max_k(sigma p_k)
==================  ============================================================================
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
