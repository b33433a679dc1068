#include "screws/meeting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace obb {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kNever = std::numeric_limits<double>::infinity();
// By how much quotients of a few roundings, 2^-51 relative, and numbers of turns are widened.
constexpr double kRelative = 0x1p-49;
constexpr double kOfTurn = 0x1p-40;

// The least and the greatest whole number in [low, high], widened outwards.
Span whole_numbers(double low, double high) {
    return {std::ceil(low - (kRelative * std::fabs(low) + kOfTurn)),
            std::floor(high + (kRelative * std::fabs(high) + kOfTurn))};
}

// By sigma the screw takes a point (r, theta, z) of B to (r, theta + sigma, z + pitch sigma), and
// with u = z - pitch theta, a point of A and one of B are in contact if and only if, for some whole
// number m of turns,
//   r_a = r_b,  theta_a + 2 pi m = theta_b + sigma,  u_a - lead m = u_b
// (and then z_a = z_b + pitch sigma). Which branch of theta an image has only renames m. Bounds of
// all four leave a range of sigma and one of m: what holds of every contact holds of the first.
// Every comparison keeps what it cannot decide, NaN as well.
class Meeting {
  public:
    Meeting(const RelativeScrew& screw, double sigma)
        : screw_(screw), sigma_{sigma, (1 + 0x1p-50) * screw.sweep} {}

    [[nodiscard]] bool is_possible() const { return is_possible_; }

    // Radius and height. Where heights must be equal at some sigma, sigma is between the quotients.
    void meet(const Span& radius_a, const Span& height_a, const Span& radius_b,
              const Span& height_b) {
        if (are_apart(radius_a, radius_b)) {
            is_possible_ = false;
            return;
        }
        if (screw_.is_hinge()) {
            is_possible_ = !are_apart(height_a, height_b);
            return;
        }
        between((height_a.low - height_b.high) / screw_.pitch,
                (height_a.high - height_b.low) / screw_.pitch);
    }

    // Angles: which numbers of turns are possible at all.
    void turn(const Span& angle_a, const Span& angle_b) {
        from_ = angle_a.low - angle_b.high;
        const double error = screw_.angle_error;
        turns_ = whole_numbers((sigma_.low - angle_a.high + angle_b.low - error) / kTurn,
                               (sigma_.high - from_ + error) / kTurn);
        is_possible_ = !(turns_.low > turns_.high);
    }

    // A direction of the plane of r and u: A's points less B's, lead m taken off, are between low
    // and high along it; `step` is a lead along it.
    void narrow(double low, double high, double step) {
        if (step == 0) {
            is_possible_ = is_possible_ && !(low > 0) && !(high < 0);
            return;
        }
        const double x = low / step, y = high / step;
        const Span turns = whole_numbers(std::min(x, y), std::max(x, y));
        turns_.low = std::max(turns_.low, turns.low);
        turns_.high = std::min(turns_.high, turns.high);
        is_possible_ = is_possible_ && !(turns_.low > turns_.high);
    }

    // The same of the plane of r and z, where B's points move by pitch * sigma: `step` is the pitch
    // along the direction.
    void narrow_profiles(double low, double high, double step) {
        if (step == 0) {
            is_possible_ = is_possible_ && !(low > 0) && !(high < 0);
            return;
        }
        between(low / step, high / step);
    }

    // The first sigma that is left. Without angles it is that of the heights.
    [[nodiscard]] double first() const {
        if (!is_possible_) {
            return kNever;
        }
        const double turned = from_ + kTurn * turns_.low;
        const double first =
            turned -
            (kRelative * (std::fabs(from_) + kTurn * std::fabs(turns_.low)) + screw_.angle_error);
        const double sigma = first > sigma_.low ? first : sigma_.low; // NaN keeps the latter
        return sigma > sigma_.high ? kNever : sigma;
    }
    [[nodiscard]] double first_height() const { return is_possible_ ? sigma_.low : kNever; }

  private:
    // Sigma is between two quotients.
    void between(double x, double y) {
        const double low = std::min(x, y), high = std::max(x, y);
        sigma_.low = std::max(sigma_.low, low - kRelative * std::fabs(low));
        sigma_.high = std::min(sigma_.high, high + kRelative * std::fabs(high));
        is_possible_ = is_possible_ && !(sigma_.low > sigma_.high);
    }
    [[nodiscard]] static bool are_apart(const Span& a, const Span& b) {
        return a.low > b.high || b.low > a.high;
    }

    const RelativeScrew& screw_;
    Span sigma_;
    Span turns_{0, 0};
    double from_ = 0; // the angle from B's far end to A's near end
    bool is_possible_ = true;
};

// Both rectangles' axes, in one plane. Half of what a rectangle covers along a direction is the sum
// over its two axes. The products are off by 3 u of the sizes in play: of the extents, and of the
// difference of the centres. Calls narrow(low, high, n) with n along u or z.
template <typename Narrow>
void narrow_rectangles(const Meeting& meeting, const Rectangle& a, const Rectangle& b,
                       const Narrow& narrow) {
    const double d_r = a.r - b.r, d_u = a.u - b.u;
    const auto along = [&](double n_r, double n_u, double own, const Rectangle& other) {
        if (!meeting.is_possible()) {
            return;
        }
        const double d = n_r * d_r + n_u * d_u;
        const double cosine = std::fabs(n_r * other.n_r + n_u * other.n_u),
                     sine = std::fabs(n_u * other.n_r - n_r * other.n_u);
        const double e = (1 + kRelative) * (own + cosine * other.e1 + sine * other.e2) +
                         kRelative * (std::fabs(d_r) + std::fabs(d_u) + other.e1 + other.e2);
        narrow(d - e, d + e, n_u);
    };
    along(a.n_r, a.n_u, a.e1, b);
    along(-a.n_u, a.n_r, a.e2, b);
    along(b.n_r, b.n_u, b.e1, a);
    along(-b.n_u, b.n_r, b.e2, a);
}

// The normals of the edges of two hulls, whose corners are (r, y). Where images lie along a
// direction is off by 3 u of their coordinates, which their slack covers: it is 512 u of radii and
// heights at least, and 32 u of |pitch angle|. Calls narrow(n_r, n_y).
template <typename Narrow>
void narrow_by_edges(const Meeting& meeting, const std::array<double, 3>& r,
                     const std::array<double, 3>& y, const Narrow& narrow) {
    for (std::size_t k = 0; k < 3 && meeting.is_possible(); ++k) {
        const double d_r = r[(k + 1) % 3] - r[k], d_y = y[(k + 1) % 3] - y[k];
        const double length = std::sqrt(d_r * d_r + d_y * d_y);
        if (length > 0x1p-400) {
            narrow(-d_y / length, d_r / length);
        }
    }
}

// What is left between two spans, widened by the rounding of the differences.
Span difference(const Span& x, const Span& y) {
    const double error =
        kRelative * (std::fabs(x.low) + std::fabs(x.high) + std::fabs(y.low) + std::fabs(y.high));
    return {x.low - y.high - error, x.high - y.low + error};
}

} // namespace

double first_meeting(const RelativeScrew& screw, const ImageNode& a, const ImageNode& b,
                     double sigma) {
    Meeting meeting(screw, sigma);
    meeting.meet(a.radius, a.height, b.radius, b.height);
    if (a.is_ring || b.is_ring) {
        // Both in one plane: u is z on a hinge.
        if ((a.is_ring && b.is_ring) || screw.is_hinge()) {
            narrow_rectangles(meeting, a.rectangle, b.rectangle,
                              [&](double low, double high, double n_z) {
                                  meeting.narrow_profiles(low, high, screw.pitch * n_z);
                              });
        }
        return meeting.first_height();
    }
    if (meeting.is_possible()) {
        meeting.turn(a.angle, b.angle);
    }
    narrow_rectangles(meeting, a.rectangle, b.rectangle, [&](double low, double high, double n_u) {
        meeting.narrow(low, high, screw.lead * n_u);
    });
    return meeting.first();
}

// The normals of both hulls and u are all axes that two such hulls need; r was looked at first, and
// z where profiles are compared.
double first_meeting(const RelativeScrew& screw, const Image& a, const Image& b, double sigma) {
    Meeting meeting(screw, sigma);
    meeting.meet(a.radius, a.height, b.radius, b.height);
    if (a.is_ring || b.is_ring) {
        const auto narrow = [&](double n_r, double n_z) {
            const Span d = difference(a.profile_along(n_r, n_z, screw.slack),
                                      b.profile_along(n_r, n_z, screw.slack));
            meeting.narrow_profiles(d.low, d.high, screw.pitch * n_z);
        };
        narrow_by_edges(meeting, a.r, a.z, narrow);
        narrow_by_edges(meeting, b.r, b.z, narrow);
        return meeting.first_height();
    }
    const auto narrow = [&](double n_r, double n_u) {
        const Span d = difference(a.along(n_r, n_u), b.along(n_r, n_u));
        meeting.narrow(d.low, d.high, screw.lead * n_u);
    };
    if (meeting.is_possible()) {
        meeting.turn(a.angle, b.angle);
    }
    if (meeting.is_possible()) {
        narrow(0, 1);
    }
    narrow_by_edges(meeting, a.r, a.u, narrow);
    narrow_by_edges(meeting, b.r, b.u, narrow);
    return meeting.first();
}

} // namespace obb
