// Attacks the bound on what floats round when boxes are told by when they may touch: random boxes
// of all proportions, near each other and far, fast and slow; 80-bit arithmetic says when their
// projections meet. Without margins some have to fail, or this would show nothing.
#include "in_motion/ray_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace {

using Real = long double;
using Vec = std::array<Real, 3>;

constexpr int kPairs = 400'000;

class Random {
  public:
    double next() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state_ >> 11U) * 0x1p-52 - 1;
    }
    double power(double least, double most) {
        return std::exp2(least + (most - least) * 0.5 * (next() + 1));
    }

    obb::Vec3 point(double length) { return {length * next(), length * next(), length * next()}; }

  private:
    std::uint64_t state_ = 20261130;
};

obb::Node random_box(Random& random, double size, obb::Vec3 center) {
    obb::Node node = obb::kNoBox;
    node.center = center;
    for (float& h : node.half_extents) {
        h = static_cast<float>(size * random.power(-20, 0));
    }
    for (float& q : node.rotation) {
        q = static_cast<float>(random.next());
    }
    return node;
}

struct Box {
    Vec center;
    std::array<Vec, 3> axes;
    Vec half_extents;
};

Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec wide(const obb::Vec3& v) { return {v.x, v.y, v.z}; }
Vec turned(const obb::Mat3& m, const Vec& v) {
    return {dot(wide(m.rows[0]), v), dot(wide(m.rows[1]), v), dot(wide(m.rows[2]), v)};
}

Box placed(const obb::Node& node, const obb::Mat3& matrix, const Vec& shift) {
    Box box;
    box.center = turned(matrix, wide(node.center));
    const auto axes = obb::axes_of(node.rotation);
    for (std::size_t k = 0; k < 3; ++k) {
        box.center[k] += shift[k];
        box.axes[k] = turned(matrix, wide(axes[k]));
        box.half_extents[k] = node.half_extents[k];
    }
    return box;
}

struct Stay {
    Real entry, exit;
};

// When all projections meet, from a time on and for a span.
Stay stay_of(const Box& a, const Box& b, const Vec& velocity, Real time, Real span) {
    Stay stay{0, span};
    const auto cut = [&](const Vec& axis) {
        Real distance = time * dot(axis, velocity), radius = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            distance += axis[k] * (b.center[k] - a.center[k]);
            radius += a.half_extents[k] * std::fabs(dot(a.axes[k], axis)) +
                      b.half_extents[k] * std::fabs(dot(b.axes[k], axis));
        }
        const Real speed = dot(axis, velocity);
        const Real one = (-radius - distance) / speed, other = (radius - distance) / speed;
        if (speed != 0) {
            stay.entry = std::max(stay.entry, std::min(one, other));
            stay.exit = std::min(stay.exit, std::max(one, other));
        }
    };
    for (std::size_t i = 0; i < 3; ++i) {
        cut(a.axes[i]);
        cut(b.axes[i]);
        for (std::size_t j = 0; j < 3; ++j) {
            cut(cross(a.axes[i], b.axes[j]));
        }
    }
    return stay;
}

// A's frame, and B's turned and shifted against it.
obb::RayFrame frame_of(const obb::Mat3& matrix, obb::Vec3 shift, obb::Vec3 velocity, float share) {
    obb::RayFrame frame;
    frame.scale_a = 1;
    frame.velocity = velocity;
    frame.speed = static_cast<float>(obb::norm_1(velocity) * (1 + 0x1p-22));
    frame.relative = share * obb::RayFrame::kRelative;
    frame.absolute = share * 0x1p-44F;
    for (std::size_t lane = 0; lane < 8; ++lane) {
        frame.node_scale[lane] = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double entry = lane / 2 % 2 == 0 ? (i == k ? 1 : 0) : matrix.rows[i][k];
                frame.matrix[i][k][lane] = static_cast<float>(entry);
            }
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        frame.rows_b[i] = {matrix.rows[i].x, matrix.rows[i].y, matrix.rows[i].z, shift[i]};
    }
    return frame;
}

// Four boxes, the pose of B against A, and how it goes on.
struct Scene {
    obb::Mat3 matrix;
    obb::Vec3 shift, velocity;
    std::array<std::array<obb::Node, 4>, 2> nodes;
    std::array<obb::RayOpening, 2> openings;

    explicit Scene(Random& random) {
        matrix = {
            obb::axes_of_quaternion(random.next(), random.next(), random.next(), random.next())};
        const double size = random.power(-30, -1), way = size * random.power(-3, 3);
        shift = random.point(0.5);
        velocity = random.point(random.power(-40, 0));
        for (std::size_t half = 0; half < 2; ++half) {
            obb::RayOpening& opening = openings[half];
            opening.time = random.power(-6, 0);
            opening.span = random.power(-10, 0) * (1 - opening.time);
            // All are near each other in the middle of the span.
            const double middle = opening.time + 0.5 * opening.span;
            const obb::Vec3 b = random.point(0.25), a = matrix * b + shift + middle * velocity;
            for (std::size_t k = 0; k < 4; ++k) {
                nodes[half][k] = random_box(random, size, (k < 2 ? a : b) + random.point(way));
                opening.nodes[k] = &nodes[half][k];
            }
            // As a question comes to them: shortly before the first of them may touch.
            const double wait =
                static_cast<double>(stay(4 * half).entry) * (1 - random.power(-20, -4));
            if (wait > 0 && wait < opening.span) {
                opening.time += wait;
                opening.span -= wait;
            }
        }
    }

    [[nodiscard]] Stay stay(std::size_t lane) const {
        const auto& boxes = nodes[lane / 4];
        const obb::RayOpening& opening = openings[lane / 4];
        const Box a = placed(boxes[obb::kRayOfA[lane % 4]], obb::Mat3::identity(), Vec{});
        const Box b = placed(boxes[2 + obb::kRayOfB[lane % 4]], matrix, wide(shift));
        return stay_of(a, b, wide(velocity), opening.time, opening.span);
    }
};

// How many pairs of boxes are said to be apart too long with a share of the margin.
int count_failures(float share) {
    Random random;
    int failures = 0;
    for (int k = 0; k < kPairs / 8; ++k) {
        const Scene scene(random);
        obb::EightEntries found;
        obb::enter_boxes(frame_of(scene.matrix, scene.shift, scene.velocity, share), scene.openings,
                         found);
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const Stay stay = scene.stay(lane);
            const bool is_cut = found.entry[lane] > stay.entry || found.exit[lane] < stay.exit;
            failures += stay.entry <= stay.exit && is_cut ? 1 : 0;
        }
    }
    return failures;
}

} // namespace

int main() {
    const int failures = count_failures(1), expected = count_failures(0);
    std::printf("%d pairs of boxes: %d are apart too long, %d would be without a margin\n", kPairs,
                failures, expected);
    return failures == 0 && expected > 100 ? 0 : 1;
}
