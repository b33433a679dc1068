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
        const double x = (height_a.low - height_b.high) / screw_.pitch,
                     y = (height_a.high - height_b.low) / screw_.pitch;
        const double low = std::min(x, y), high = std::max(x, y);
        sigma_.low = std::max(sigma_.low, low - kRelative * std::fabs(low));
        sigma_.high = std::min(sigma_.high, high + kRelative * std::fabs(high));
        is_possible_ = !(sigma_.low > sigma_.high);
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
    [[nodiscard]] static bool are_apart(const Span& a, const Span& b) {
        return a.low > b.high || b.low > a.high;
    }

    const RelativeScrew& screw_;
    Span sigma_;
    Span turns_{0, 0};
    double from_ = 0; // the angle from B's far end to A's near end
    bool is_possible_ = true;
};

// Half of what B's rectangle covers along a direction is the sum over its two axes. The products
// are off by 3 u of the sizes in play: of the extents, and of the difference of the centres.
void narrow_along(Meeting& meeting, double n_r, double n_u, double own, const Rectangle& other,
                  double d_r, double d_u, double lead) {
    const double d = n_r * d_r + n_u * d_u;
    const double cosine = std::fabs(n_r * other.n_r + n_u * other.n_u),
                 sine = std::fabs(n_u * other.n_r - n_r * other.n_u);
    const double e = (1 + kRelative) * (own + cosine * other.e1 + sine * other.e2) +
                     kRelative * (std::fabs(d_r) + std::fabs(d_u) + other.e1 + other.e2);
    meeting.narrow(d - e, d + e, lead * n_u);
}

// Where images lie along a direction is off by 3 u of their coordinates, which their slack covers:
// it is 512 u of radii and heights at least, and 32 u of |pitch angle|.
void narrow_along(Meeting& meeting, double n_r, double n_u, const Image& a, const Image& b,
                  double lead) {
    const Span x = a.along(n_r, n_u), y = b.along(n_r, n_u);
    const double error =
        kRelative * (std::fabs(x.low) + std::fabs(x.high) + std::fabs(y.low) + std::fabs(y.high));
    meeting.narrow(x.low - y.high - error, x.high - y.low + error, lead * n_u);
}

// The normal of each edge of an image in the plane of r and u.
void narrow_by_edges(Meeting& meeting, const Image& own, const Image& a, const Image& b,
                     double lead) {
    for (std::size_t k = 0; k < 3 && meeting.is_possible(); ++k) {
        const double d_r = own.r[(k + 1) % 3] - own.r[k], d_u = own.u[(k + 1) % 3] - own.u[k];
        const double length = std::sqrt(d_r * d_r + d_u * d_u);
        if (length > 0x1p-400) {
            narrow_along(meeting, -d_u / length, d_r / length, a, b, lead);
        }
    }
}

} // namespace

double first_meeting(const RelativeScrew& screw, const ImageNode& a, const ImageNode& b,
                     double sigma) {
    Meeting meeting(screw, sigma);
    meeting.meet(a.radius, a.height, b.radius, b.height);
    if (a.is_ring || b.is_ring || !meeting.is_possible()) {
        return meeting.first_height();
    }
    meeting.turn(a.angle, b.angle);
    const Rectangle &p = a.rectangle, &q = b.rectangle;
    const double d_r = p.r - q.r, d_u = p.u - q.u;
    if (meeting.is_possible()) {
        narrow_along(meeting, p.n_r, p.n_u, p.e1, q, d_r, d_u, screw.lead);
    }
    if (meeting.is_possible()) {
        narrow_along(meeting, -p.n_u, p.n_r, p.e2, q, d_r, d_u, screw.lead);
    }
    if (meeting.is_possible()) {
        narrow_along(meeting, q.n_r, q.n_u, q.e1, p, d_r, d_u, screw.lead);
    }
    if (meeting.is_possible()) {
        narrow_along(meeting, -q.n_u, q.n_r, q.e2, p, d_r, d_u, screw.lead);
    }
    return meeting.first();
}

// The normals of both hulls and u are all axes that two such hulls need; r was looked at first.
double first_meeting(const RelativeScrew& screw, const Image& a, const Image& b, double sigma) {
    Meeting meeting(screw, sigma);
    meeting.meet(a.radius, a.height, b.radius, b.height);
    if (a.is_ring || b.is_ring || !meeting.is_possible()) {
        return meeting.first_height();
    }
    meeting.turn(a.angle, b.angle);
    if (meeting.is_possible()) {
        narrow_along(meeting, 0, 1, a, b, screw.lead);
    }
    narrow_by_edges(meeting, a, a, b, screw.lead);
    narrow_by_edges(meeting, b, a, b, screw.lead);
    return meeting.first();
}

} // namespace obb
