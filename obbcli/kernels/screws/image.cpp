#include "screws/image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace obb {

namespace {

constexpr double kPi = std::numbers::pi;
// Triangles are cut while their corners' angles span more than this, rad, so many times at most.
constexpr double kWide = 0.35;
constexpr unsigned kMostCuts = 6;
// Corners whose angles span less than this, less than pi by far, do not surround the axis.
constexpr double kSurrounds = 3;
// Of its largest radius: what is nearer to the axis is a ring.
constexpr double kNear = 1e-3;
// Bodies of more leads than this keep their angles.
constexpr double kMostLeads = 256;
// Covers the rounding of what is made of few factors.
constexpr double kAbove = 1 + 0x1p-30;

// The angles of corners, each within pi of the first one's.
std::array<double, 3> unwrapped(const std::array<AxialPoint, 3>& corners) {
    std::array<double, 3> angles{corners[0].angle, corners[1].angle, corners[2].angle};
    for (std::size_t k = 1; k < 3; ++k) {
        const double turn = angles[k] - angles[0];
        angles[k] += turn > kPi ? -2 * kPi : turn <= -kPi ? 2 * kPi : 0;
    }
    return angles;
}

Span span_of(const std::array<double, 3>& x) {
    return {std::min({x[0], x[1], x[2]}), std::max({x[0], x[1], x[2]})};
}

// The widest angle between corners; NaN where one has none.
double width_of(const std::array<AxialPoint, 3>& corners) {
    const std::array<double, 3> angles = unwrapped(corners);
    const bool has_all = !std::isnan(angles[0] + angles[1] + angles[2]);
    return has_all ? span_of(angles).length() : std::numeric_limits<double>::quiet_NaN();
}

AxialPoint middle(const AxialPoint& p, const AxialPoint& q) {
    return axial_point(0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y, 0.5 * p.z + 0.5 * q.z);
}

// From the axis to the point of a triangle that is nearest to it, or to the middle of its corners
// where that is on the axis; a unit vector to 4 u.
std::array<double, 2> nearest_direction(const std::array<AxialPoint, 3>& corners) {
    double nearest = std::numeric_limits<double>::infinity();
    std::array<double, 2> to{1, 0};
    const auto consider = [&](double x, double y) {
        const double r = std::sqrt(x * x + y * y);
        if (r > 0x1p-400 && r < nearest) {
            nearest = r;
            to = {x / r, y / r};
        }
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const AxialPoint &p = corners[k], &q = corners[(k + 1) % 3];
        const double dx = q.x - p.x, dy = q.y - p.y, square = dx * dx + dy * dy;
        const double t = square > 0 ? std::clamp(-(p.x * dx + p.y * dy) / square, 0.0, 1.0) : 0.0;
        consider(p.x + t * dx, p.y + t * dy);
    }
    return to;
}

std::array<double, 2> middle_direction(const std::array<AxialPoint, 3>& corners) {
    const double x = corners[0].x + corners[1].x + corners[2].x,
                 y = corners[0].y + corners[1].y + corners[2].y, r = std::sqrt(x * x + y * y);
    return r > 0x1p-400 ? std::array{x / r, y / r} : std::array{1.0, 0.0};
}

} // namespace

// The angle need not be trusted to be that of the platform's library: sine and cosine, which are
// within 1 ulp (a test asks for it), tell how far off it is. With d the distance of the true angle,
// |x sin - y cos| = r |sin d|, rounded by 6 u r; so d is below 2^-46 + 6 u, or pi less that, which
// the sign of x cos + y sin excludes. In a subnormal or NaN all comparisons fail.
AxialPoint axial_point(double x, double y, double z) {
    constexpr double kClose = 0x1p-46;
    const double radius = std::sqrt(x * x + y * y);
    const double angle = std::atan2(y, x), sine = std::sin(angle), cosine = std::cos(angle);
    const bool is_good = std::fabs(x * sine - y * cosine) <= kClose * radius &&
                         x * cosine + y * sine > 0 && radius > 0x1p-400;
    return {x, y, z, radius, is_good ? angle : std::numeric_limits<double>::quiet_NaN()};
}

AxialPoint axial_point(const RelativeScrew& screw, Vec3 position, Vec3 shift) {
    const Vec3 p = position + shift;
    return axial_point(dot(p, screw.across), dot(p, screw.third), dot(p, screw.axis));
}

Span Image::along(double n_r, double n_u) const {
    const std::array<double, 3> reach{n_r * r[0] + n_u * u[0], n_r * r[1] + n_u * u[1],
                                      n_r * r[2] + n_u * u[2]};
    const Span hull = span_of(reach);
    const double sag = n_r * sag_r, both = std::fabs(n_u) * sag_u + round;
    return {hull.low - std::max(0.0, sag) - both, hull.high + std::max(0.0, -sag) + both};
}

Span Image::profile_along(double n_r, double n_z, double slack) const {
    const std::array<double, 3> reach{n_r * r[0] + n_z * z[0], n_r * r[1] + n_z * z[1],
                                      n_r * r[2] + n_z * z[2]};
    const Span hull = span_of(reach);
    const double sag = n_r * sag_r, both = kAbove * slack;
    return {hull.low - std::max(0.0, sag) - both, hull.high + std::max(0.0, -sag) + both};
}

ImageMaker::ImageMaker(const RelativeScrew& screw, double base, double extent)
    : pitch_(screw.pitch), lead_(screw.lead), slack_(screw.slack), base_(base),
      is_shifted_(2 * extent < kMostLeads * std::fabs(screw.lead)) {}

void ImageMaker::add(const std::array<AxialPoint, 3>& corners, std::uint32_t triangle,
                     std::vector<Image>& images) const {
    Image image{};
    image.triangle = triangle;
    image.is_piece = false;
    cut(corners, 0, image, images);
}

// Halves the longest edge across the axis. The halves of an edge that triangles share are the same.
void ImageMaker::cut(const std::array<AxialPoint, 3>& corners, unsigned depth, Image& image,
                     std::vector<Image>& images) const {
    const double farthest = std::max({corners[0].radius, corners[1].radius, corners[2].radius});
    const bool is_narrow = width_of(corners) <= kWide; // where there is no angle it is not
    if (!is_narrow && depth < kMostCuts && farthest > 8 * slack_) {
        std::size_t longest = 0;
        double most = -1;
        for (std::size_t k = 0; k < 3; ++k) {
            const AxialPoint &p = corners[k], &q = corners[(k + 1) % 3];
            const double square = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
            if (square > most) {
                most = square;
                longest = k;
            }
        }
        const AxialPoint &p = corners[longest], &q = corners[(longest + 1) % 3],
                         &opposite = corners[(longest + 2) % 3], half = middle(p, q);
        image.is_piece = true;
        cut({p, half, opposite}, depth + 1, image, images);
        cut({half, q, opposite}, depth + 1, image, images);
        return;
    }
    if (!set(corners, image)) {
        set_ring(corners, image);
    }
    images.push_back(image);
}

// Any unit vector e across the axis bounds the radius of a point sum c_i q_i from below, by
// sum c_i e.q_i: so by the least e.q_i, and by sum c_i r_i less the most that r_i exceeds e.q_i. A
// radius is at least 0, and convex: at most sum c_i r_i. All of this is off by 8 u of the radii,
// which the slack covers.
void ImageMaker::set_ring(const std::array<AxialPoint, 3>& corners, Image& image) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto near = nearest_direction(corners), middle = middle_direction(corners);
    double least = kInfinity, sag = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const AxialPoint& p = corners[k];
        image.r[k] = p.radius;
        image.u[k] = image.z[k] = p.z;
        least = std::min(least, near[0] * p.x + near[1] * p.y);
        sag = std::max(sag, p.radius - (middle[0] * p.x + middle[1] * p.y));
    }
    const double most = span_of(image.r).high;
    const Span height = span_of(image.z);
    image.is_ring = true;
    image.radius = {std::max(0.0, least) - slack_, most + slack_};
    image.height = {height.low - slack_, height.high + slack_};
    image.angle = {-kInfinity, kInfinity};
    image.sag_r = kAbove * std::min(sag, most);
    image.sag_u = 0;
    image.round = kAbove * slack_;
}

// What bounds the image, where corners i have radii r_i and angles t_i that span D = 2 h < pi about
// their middle m, and a point of the triangle is sum c_i q_i with c_i >= 0, sum c_i = 1:
//   - r is the length of a linear map, so convex: r <= sum c_i r_i. For e = (cos m, sin m),
//     r >= e.q and e.q_i = r_i cos(t_i - m) >= r_i (1 - h^2 / 2): r >= sum c_i r_i - sag_r with
//     sag_r = r_max h^2 / 2, and r >= r_min (1 - h^2 / 2).
//   - Let t be the point's angle and b_i = t - t_i, |b_i| <= D. By definition of t,
//     sum c_i r_i sin b_i = 0, so for any s: t - sum c_i t_i = sum c_i (b_i - sin b_i)
//     + sum c_i r_i (1 / r_i - s) sin b_i. The first sum is at most D^3 / 6. In the second the
//     positive and the negative part of sum c_i r_i sin b_i are equal, and at most r_max D / 4
//     each: two groups of weights M, M' whose sum is at most r_max, with means x, x' whose sum is
//     at most D, and M x = M' x', have M x = (M + M') x x' / (x + x'). With s midway between the
//     extremes of 1 / r_i that makes |t - sum c_i t_i| <= D^3 / 6 + (r_max / r_min - 1) D / 4; it
//     is at most D anyway. With z linear, u is off by |pitch| times that: sag_u.
//   - A point that is off by d <= slack moves along a unit n of the plane of r and u by at most
//     d sqrt(1 + (pitch / r)^2), as |grad (n_r r + n_u u)| is at most that, with r at least
//     r_min - slack on the way: a disc. Its angle moves by asin(d / r) <= 1.05 d / r for
//     d <= r / 2.
// Rounding: radii and heights are off by 2 u, which the slack covers 500 times. Angles are off by
// 2^-45 (see axial_point), a shift by m turns by 4 pi m u, differences by 4 u pi, pitch * angle by
// u of itself: 2^-44 + 2^-49 |angle| rad, and |pitch| times twice that in u. D is taken larger by
// 2^-43, which covers its own rounding, and sags by kAbove.
bool ImageMaker::set(const std::array<AxialPoint, 3>& corners, Image& image) const {
    std::array<double, 3> angles = unwrapped(corners);
    image.r = {corners[0].radius, corners[1].radius, corners[2].radius};
    const Span around = span_of(angles), radius = span_of(image.r),
               height = span_of({corners[0].z, corners[1].z, corners[2].z});
    const double width = width_of(corners) + 0x1p-43, half = 0.5 * width;
    const double least = radius.low * std::max(0.0, 1 - 0.5 * half * half);
    if (!(width < kSurrounds) || !(least > 4 * slack_) || !(least >= kNear * radius.high)) {
        return false;
    }
    double shift = 0;
    if (is_shifted_ && lead_ != 0) {
        const double mean =
            (corners[0].z + corners[1].z + corners[2].z - 3 * base_) / 3 - pitch_ * around.middle();
        shift = 2 * kPi * std::floor(mean / lead_);
    }
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        angles[k] += shift;
        image.z[k] = corners[k].z;
        image.u[k] = corners[k].z - pitch_ * angles[k];
        largest = std::max(largest, std::fabs(angles[k]));
    }
    const double error = 0x1p-44 + 0x1p-49 * largest;
    const double angle_slack = kAbove * 1.05 * slack_ / least + error;
    const Span turned = span_of(angles);
    image.is_ring = false;
    image.angle = {turned.low - angle_slack, turned.high + angle_slack};
    image.radius = {least - slack_, radius.high + slack_};
    image.height = {height.low - slack_, height.high + slack_};
    const double bent =
        std::min(width, width * width * width / 6 + (radius.high / radius.low - 1) * 0.25 * width);
    image.sag_r = kAbove * 0.5 * radius.high * half * half;
    image.sag_u = kAbove * std::fabs(pitch_) * bent;
    const double steep = pitch_ / (least - slack_);
    image.round = kAbove * (slack_ * std::sqrt(1 + steep * steep) + 2 * std::fabs(pitch_) * error);
    return true;
}

} // namespace obb
