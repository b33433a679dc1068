// Attacks the bounds on what floats round when boxes and triangles are told how far apart they are:
// random ones of all proportions, most of them nearly along each other. Two points in 80-bit
// arithmetic, about the nearest ones, say how far apart they are at most. Without margins some
// bounds have to exceed that, or this would show nothing.
#include "distance/gap_lanes.hpp"
#include "distance/triangle_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

namespace {

using Real = long double;
using Vec = std::array<Real, 3>;

constexpr int kBoxPairs = 200'000, kTrianglePairs = 320'000;

class Random {
  public:
    double next() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state_ >> 11U) * 0x1p-52 - 1;
    }
    double power(double least, double most) {
        return std::exp2(least + (most - least) * 0.5 * (next() + 1));
    }
    unsigned below(unsigned count) {
        return static_cast<unsigned>(0.5 * (next() + 1) * count) % count;
    }
    obb::Vec3 point(double length) {
        const double x = length * next(), y = length * next();
        return {x, y, length * next()};
    }

  private:
    std::uint64_t state_ = 20261130;
};

Vec wide(const obb::Vec3& v) { return {v.x, v.y, v.z}; }
Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec operator*(Real s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec turned(const obb::Mat3& m, const Vec& v) {
    return {dot(wide(m.rows[0]), v), dot(wide(m.rows[1]), v), dot(wide(m.rows[2]), v)};
}

struct Box {
    Vec center;
    std::array<Vec, 3> axes;
    Vec half_extents;

    // The point nearest to one.
    [[nodiscard]] Vec nearest(const Vec& to) const {
        Vec point = center;
        for (std::size_t k = 0; k < 3; ++k) {
            const Real along = dot(axes[k], to - center) / dot(axes[k], axes[k]);
            point = point + std::clamp(along, -half_extents[k], half_extents[k]) * axes[k];
        }
        return point;
    }
};

Box placed(const obb::Node& node, const obb::Mat3& matrix, const Vec& shift) {
    Box box;
    box.center = turned(matrix, wide(node.center)) + shift;
    const auto axes = obb::axes_of(node.rotation);
    for (std::size_t k = 0; k < 3; ++k) {
        box.axes[k] = turned(matrix, wide(axes[k]));
        box.half_extents[k] = node.half_extents[k];
    }
    return box;
}

// Of two points, by turns each the nearest to the other: no less than the distance.
Real distance(const Box& a, const Box& b) {
    Vec p = a.nearest(b.center), q = b.nearest(p);
    for (int k = 0; k < 60; ++k) {
        p = a.nearest(q);
        q = b.nearest(p);
    }
    return std::sqrt(dot(q - p, q - p));
}

obb::Node random_box(Random& random, double size, obb::Vec3 center,
                     const std::array<float, 4>& rotation) {
    obb::Node node = obb::kNoBox;
    node.center = center;
    for (float& h : node.half_extents) {
        h = static_cast<float>(size * random.power(-20, 0));
    }
    node.rotation = rotation;
    return node;
}

// A's frame, and B's turned and shifted against it; with a share of the margins.
obb::GapFrame frame_of(const obb::Mat3& matrix, obb::Vec3 shift, float share) {
    const obb::TreeView tree{};
    obb::PosedTree a(tree, {}), b(tree, {});
    a.set_frame(obb::Mat3::identity(), {0, 0, 0}, 0);
    b.set_frame(matrix, shift, 0);
    obb::GapFrame frame;
    frame.set(a, b, {64 * obb::kUnitRoundoff, 0x1p-900}, 1);
    for (std::size_t lane = 0; lane < 8; ++lane) {
        frame.of_way[lane] *= share;
        frame.of_sizes[lane] *= share;
        frame.absolute[lane] *= share;
    }
    return frame;
}

struct Failures {
    int with = 0, without = 0;
};

void attack_boxes(Random& random, Failures& failures) {
    const auto quaternion = [&] {
        std::array<float, 4> q;
        for (float& number : q) {
            number = static_cast<float>(random.next());
        }
        return q;
    };
    // Turned by nothing where boxes are to lie along each other.
    const bool is_along = random.below(2) == 0;
    const obb::Mat3 matrix = is_along
                                 ? obb::Mat3::identity()
                                 : obb::Mat3{obb::axes_of_quaternion(random.next(), random.next(),
                                                                     random.next(), random.next())};
    const double size = random.power(-30, -1), way = size * random.power(-3, 6);
    const obb::Vec3 shift = random.point(0.5);
    std::array<obb::Node, 8> nodes;
    obb::EightNodes places;
    for (std::size_t half = 0; half < 2; ++half) {
        const obb::Vec3 b = random.point(0.25), a = matrix * b + shift;
        const std::array<float, 4> rotation = quaternion();
        for (std::size_t k = 0; k < 4; ++k) {
            obb::Node& node = nodes[4 * half + k];
            node = random_box(random, size, (k < 2 ? a : b) + random.point(way),
                              is_along ? rotation : quaternion());
            places[4 * half + k] = &node;
        }
    }
    obb::EightGaps gaps, bare;
    const obb::GapFrame frame = frame_of(matrix, shift, 1);
    obb::measure_gaps(frame, places, gaps);
    obb::measure_gaps(frame_of(matrix, shift, 0), places, bare);
    for (std::size_t lane = 0; lane < 8; ++lane) {
        const std::size_t first = lane / 4 * 4;
        const Real apart =
            distance(placed(nodes[first + obb::kOfA[lane % 4]], obb::Mat3::identity(), Vec{}),
                     placed(nodes[first + 2 + obb::kOfB[lane % 4]], matrix, wide(shift)));
        failures.with += Real{frame.shrink} * gaps.low[lane] > apart ? 1 : 0;
        failures.without += Real{bare.low[lane]} > apart ? 1 : 0;
    }
}

// How many bounds a box that is no number proves: one of eight boxes, in each of its numbers.
int count_proofs_of_nothing(Random& random) {
    int proofs = 0;
    const obb::GapFrame frame = frame_of(obb::Mat3::identity(), {0.5, 0.25, 0.125}, 1);
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (std::size_t which = 0; which < 8; ++which) {
            for (std::size_t field = 0; field < 10; ++field) {
                std::array<obb::Node, 8> nodes;
                obb::EightNodes places;
                for (std::size_t k = 0; k < 8; ++k) {
                    nodes[k] = random_box(random, 0.01, random.point(0.25), {1, 0, 0, 0});
                    places[k] = &nodes[k];
                }
                obb::Node& node = nodes[which];
                if (field < 3) {
                    node.center[field] = bad;
                } else if (field < 6) {
                    node.half_extents[field - 3] = static_cast<float>(std::fabs(bad));
                } else {
                    node.rotation[field - 6] = static_cast<float>(bad);
                }
                obb::EightGaps gaps;
                obb::measure_gaps(frame, places, gaps);
                for (std::size_t lane = 0; lane < 8; ++lane) {
                    const std::size_t first = lane / 4 * 4;
                    const bool is_of_it = first + obb::kOfA[lane % 4] == which ||
                                          first + 2 + obb::kOfB[lane % 4] == which;
                    proofs += is_of_it && gaps.low[lane] != 0 ? 1 : 0;
                }
            }
        }
    }
    return proofs;
}

using Corners = std::array<Vec, 3>;

// The point of a segment nearest to one.
Vec nearest_on(const Vec& start, const Vec& end, const Vec& to) {
    const Vec edge = end - start;
    const Real square = dot(edge, edge);
    const Real along = square > 0 ? dot(edge, to - start) / square : 0;
    return start + std::clamp<Real>(along, 0, 1) * edge;
}
// The distance of a point from a triangle, or more; infinite where it is not above the face.
Real above_face(const Corners& t, const Vec& p) {
    const Vec n = cross(t[1] - t[0], t[2] - t[0]);
    for (std::size_t k = 0; k < 3; ++k) {
        if (dot(cross(n, t[(k + 1) % 3] - t[k]), p - t[k]) < 0) {
            return std::numeric_limits<Real>::infinity();
        }
    }
    const Real square = dot(n, n);
    return square > 0 ? std::fabs(dot(n, p - t[0])) / std::sqrt(square)
                      : std::numeric_limits<Real>::infinity();
}
Real distance(const Corners& a, const Corners& b) {
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        least = std::min({least, above_face(a, b[i]), above_face(b, a[i])});
        for (std::size_t j = 0; j < 3; ++j) {
            Vec p = a[i], q = b[j];
            for (int k = 0; k < 30; ++k) {
                p = nearest_on(a[i], a[(i + 1) % 3], q);
                q = nearest_on(b[j], b[(j + 1) % 3], p);
            }
            least = std::min(least, std::sqrt(dot(q - p, q - p)));
        }
    }
    return least;
}

obb::TriangleBlock random_block(Random& random, obb::Vec3 center, double size, bool is_flat) {
    obb::TriangleBlock block;
    for (auto& corner : block.corners) {
        for (std::size_t lane = 0; lane < 4; ++lane) {
            obb::Vec3 p = center + random.point(size * random.power(-8, 0));
            if (is_flat) {
                p.z = center.z;
            }
            corner[0][lane] = p.x;
            corner[1][lane] = p.y;
            corner[2][lane] = p.z;
        }
    }
    block.describe({1, 1});
    return block;
}
Corners corners_of(const obb::TriangleBlock& block, std::size_t k) {
    const obb::Triangle t = obb::lane(block.corners, k);
    return {wide(t[0]), wide(t[1]), wide(t[2])};
}

void attack_triangles(Random& random, Failures& failures) {
    const bool is_flat = random.below(2) == 0, is_tiny = random.below(2) == 0;
    const double size = random.power(is_tiny ? -90 : -40, -2), gap = size * random.power(-12, 4);
    const obb::Vec3 center = random.point(is_tiny ? size : 0.5);
    const obb::TriangleBlock a = random_block(random, center, size, is_flat);
    const obb::TriangleBlock b = random_block(
        random, center + (is_flat ? obb::Vec3{0, 0, gap} : random.point(gap)), size, is_flat);
    obb::BlockGaps gaps;
    obb::measure_block(a, b, 0, gaps);
    for (std::uint32_t k = 0; k < 16; ++k) {
        const Real apart = distance(corners_of(a, k % 4), corners_of(b, obb::second_of_pair(k)));
        failures.with += gaps.lows[k] > apart ? 1 : 0;
        failures.without += Real{gaps.lows[k]} + gaps.margin > apart ? 1 : 0;
    }
}

bool report(const char* name, int pairs, const Failures& failures) {
    std::printf("%d pairs of %s: %d are nearer than bounds say, %d would be without a margin\n",
                pairs, name, failures.with, failures.without);
    return failures.with == 0 && failures.without > 100;
}

} // namespace

int main() {
    Random random;
    Failures boxes, triangles;
    for (int k = 0; k < kBoxPairs / 8; ++k) {
        attack_boxes(random, boxes);
    }
    for (int k = 0; k < kTrianglePairs / 16; ++k) {
        attack_triangles(random, triangles);
    }
    const bool hold_boxes = report("boxes", kBoxPairs, boxes);
    const bool hold_triangles = report("triangles", kTrianglePairs, triangles);
    const int proofs = count_proofs_of_nothing(random);
    std::printf("%d bounds by boxes that are no numbers\n", proofs);
    return hold_boxes && hold_triangles && proofs == 0 ? 0 : 1;
}
