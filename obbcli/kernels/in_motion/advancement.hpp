// How long two shapes that are apart stay apart: steps on separating axes that hold for a while.
//
// Along a fixed n a point of a body at pivot K_t has the coordinate n.(K_t + R y). Its velocity is
// n.(V + W x R y), its acceleration at most |W| |n x W| rho, with rho the point's distance from the
// body's axis. So a gap g that closes at rate -w stays open for the positive root h of
// g + w h - a h^2 / 2 = 0. And however often the body turns, the point stays on its circle: centre
// n.(K_t + (k.Ry) k), radius rho |n x k|. Each is a proof for all of [t, t + h).
#pragma once

#include "numbers/one_lane.hpp"
#include "numbers/registers.hpp"
#include "shapes/screw.hpp"

#include <limits>

namespace obb {

// Both bodies at one time, as the steps need them. Positions are relative to each body's own pivot;
// the pivots' own motion is what B's does beyond A's.
struct MovingFrame {
    Vec3 between;          // B's pivot less A's at this time
    Vec3 closing_velocity; // B's linear velocity less A's
    const Spin* spin_a;
    const Spin* spin_b;
    double remaining;        // time left
    double relative;         // rounding of a projection, times the sizes in play
    double absolute;         // rounding of the positions themselves, plus the clearance asked for
    bool seeks_near = false; // whether boxes are looked at along their nearest points as well
};

// The positive root of g + w h - a h^2 / 2 for g > 0 and a >= 0: infinite where the gap never
// closes. Written so that nothing cancels; 2^-48 covers its rounding.
template <typename Real>
[[nodiscard]] OBB_INLINE Real closing_time(const Real& g, const Real& w, const Real& a) {
    const Real root = root_of(w * w + Real(2.0) * a * g);
    const auto opens = w > Real(0.0);
    const Real numerator = select(opens, root + w, Real(2.0) * g);
    const Real denominator = select(opens, a, root - w);
    return Real(1.0 - 0x1p-48) * numerator / denominator;
}

} // namespace obb
