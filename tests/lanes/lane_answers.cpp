// Prints all bits of answers and counts, to be compared between kernels compiled for registers of
// one width and of another.
#include "at_rest/static_query.hpp"
#include "build/tree_build.hpp"
#include "distance/distance_query.hpp"
#include "in_motion/contact_query.hpp"
#include "numbers/registers.hpp"
#include "tree/crc32.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace {

constexpr int kPoses = 12;

struct Surface {
    std::vector<obb::Vec3> vertices;
    std::vector<obb::Corners> corners;
};

// The same numbers wherever it is compiled.
class Random {
  public:
    double next() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return std::ldexp(static_cast<double>(state_ >> 11U), -52) - 1;
    }
    obb::Vec3 point() {
        const double x = next(), y = next();
        return {x, y, next()};
    }

  private:
    std::uint64_t state_ = 7;
};

// A rolled grid with bumps of polynomials: no library's sine decides.
Surface bumpy_grid(int count) {
    Surface s;
    for (int i = 0; i <= count; ++i) {
        for (int j = 0; j <= count; ++j) {
            const double x = 2.0 * i / count - 1, y = 2.0 * j / count - 1;
            s.vertices.push_back({x, y, 0.4 * x * x - 0.3 * y * y * y + 0.1 * x * y});
        }
    }
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const auto p = static_cast<std::uint32_t>(i * (count + 1) + j);
            const auto q = p + static_cast<std::uint32_t>(count) + 1;
            s.corners.push_back({p, q, p + 1});
            s.corners.push_back({p + 1, q, q + 1});
        }
    }
    return s;
}

// Triangles all over the place, some of them points, of any size.
Surface soup(int count, double size) {
    Surface s;
    Random random;
    for (int i = 0; i < count; ++i) {
        const obb::Vec3 center = size * random.point();
        const double reach = i % 17 == 0 ? 0 : size * 0.2;
        const auto first = static_cast<std::uint32_t>(s.vertices.size());
        for (int k = 0; k < 3; ++k) {
            s.vertices.push_back(center + reach * random.point());
        }
        s.corners.push_back({first, first + 1, first + 2});
    }
    return s;
}

void print(const char* name, std::span<const double> values,
           std::span<const std::uint64_t> counts) {
    std::printf("%s", name);
    for (const double value : values) {
        std::printf(" %a", value);
    }
    for (const std::uint64_t count : counts) {
        std::printf(" %llu", static_cast<unsigned long long>(count));
    }
    std::printf("\n");
}

template <typename Counts>
std::array<std::uint64_t, 4> all(const Counts& c) {
    return {c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops};
}

// FNV-1a.
template <typename Item>
std::uint64_t digest(std::span<const Item> items) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const std::byte byte : std::as_bytes(items)) {
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3U;
    }
    return hash;
}

// Turned by a quaternion, exactly the same wherever it is compiled.
obb::Pose pose(Random& random, double size, double away) {
    const auto [w, x, y, z] = std::array{1.0, random.next(), random.next(), random.next()};
    const auto axes = obb::axes_of_quaternion(w, x, y, z);
    return {obb::Mat3{axes}, size * away * random.point()};
}

void ask_at_rest(const obb::TreeView& a, const obb::TreeView& b, const obb::Pose& at) {
    obb::StaticQuery pairs(a, {}, b, at, {.all_pairs = true});
    while (!pairs.advance(100'000)) {
    }
    print("pairs", {}, all(pairs.counts()));
    print("found", {}, std::array{pairs.pairs().size(), digest(pairs.pairs())});
    obb::StaticQuery any(a, {}, b, at, {});
    while (!any.advance(100'000)) {
    }
    print("any", std::array{any.is_contact() ? 1.0 : 0.0}, all(any.counts()));
    obb::DistanceQuery nearest(a, {}, b, at, {});
    while (!nearest.advance(100'000)) {
    }
    print("distance", std::array{nearest.bounds().low, nearest.bounds().high},
          all(nearest.counts()));
}

constexpr std::uint64_t kMostPops = 20'000;

void ask_moving(const obb::TreeView& a, const obb::TreeView& b, obb::Pose at, double size,
                Random& random, int index) {
    obb::Screw here, there;
    there.linear_velocity = (index % 6 == 5 ? 1.0 : -2.0 / 3.0) * at.translation;
    there.pivot = at.translation;
    const double turns = index % 4 == 3 ? 300 : 2; // many turns have bounds of their own
    here.angular_velocity = index % 3 > 0 ? turns * random.point() : obb::Vec3{0, 0, 0};
    there.angular_velocity = index % 3 > 1 ? turns * random.point() : obb::Vec3{0, 0, 0};
    obb::ContactQueryOptions options{.duration = 2, .time_tolerance = 1e-7};
    options.limits.clearance = index % 5 == 4 ? 0.01 * size : 0;
    obb::ContactQuery query(a, {}, here, b, at, there, options);
    while (query.counts().pops < kMostPops && !query.advance(kMostPops - query.counts().pops)) {
    }
    print("moving", std::array{query.lower_bound()}, all(query.counts()));
    if (const auto& found = query.contact()) {
        const obb::ContactPlace place = query.place(*found);
        print("contact",
              std::array{found->low, found->high, found->distance, place.point_a.x, place.point_b.y,
                         place.normal.x, place.normal_a.y, place.normal_b.z},
              std::array<std::uint64_t, 2>{found->triangle_a, found->triangle_b});
    }
}

void ask(const Surface& s, const obb::BuildOptions& options, double size) {
    obb::TreeBuilder tree(s.vertices, s.corners, options, false, 1);
    while (!tree.advance(100'000)) {
    }
    print("tree", {},
          std::array<std::uint64_t, 4>{tree.node_count(), digest(tree.nodes()),
                                       digest(tree.triangle_ids()),
                                       obb::crc32(std::as_bytes(tree.nodes()))});
    Random random;
    for (int i = 0; i < kPoses; ++i) {
        ask_at_rest(tree.view(), tree.view(), pose(random, size, 0.3 * (i % 4)));
        ask_moving(tree.view(), tree.view(), pose(random, size, 4), size, random, i);
    }
}

} // namespace

int main() {
#ifndef OBB_NARROW
    if (!obb::has_wide_registers()) {
        std::fprintf(stderr, "this machine has no wide registers: there is nothing to compare\n");
    }
#endif
    for (const obb::Fit fit : {obb::Fit::kTriangles, obb::Fit::kPoints, obb::Fit::kHull,
                               obb::Fit::kMinVolume, obb::Fit::kAxisAligned}) {
        ask(bumpy_grid(24), {.fit = fit}, 1);
        ask(soup(300, 1), {.fit = fit, .split = obb::Split::kMedian}, 1);
    }
    for (const obb::Split split : {obb::Split::kMedian, obb::Split::kCenter}) {
        ask(bumpy_grid(24), {.split = split}, 1);
    }
    for (const double size : {0x1p-200, 1e3, 0x1p200}) {
        ask(soup(500, size), {.split = obb::Split::kCenter, .leaf_size = 3}, size);
    }
    ask(bumpy_grid(150), {}, 1); // enough for the passes over many triangles
    return 0;
}
