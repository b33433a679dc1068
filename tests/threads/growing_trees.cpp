// Questions from several threads to trees that grow, or are read, as they are asked, for the thread
// sanitizer: every answer must be that of one thread and whole trees.
#include "at_rest/containment_query.hpp"
#include "at_rest/static_query.hpp"
#include "build/tree_build.hpp"
#include "distance/distance_query.hpp"
#include "in_motion/contact_query.hpp"
#include "in_motion/contact_sweep.hpp"
#include "tree/crc32.hpp"
#include "tree/file_tree.hpp"
#include "work/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

constexpr int kRings = 24;
constexpr int kSectors = 40;
constexpr int kRounds = 6;
constexpr std::size_t kThreads = 4;
constexpr std::size_t kPoses = 8;
constexpr std::size_t kContacts = 20;

struct Surface {
    std::vector<obb::Vec3> vertices;
    std::vector<obb::Corners> corners;
};

// A torus with bumps.
Surface bumpy_torus() {
    Surface s;
    const double turn = 2 * std::acos(-1.0);
    for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kSectors; ++j) {
            const double u = turn * i / kRings, v = turn * j / kSectors;
            const double r = 0.3 + 0.04 * std::sin(5 * u) * std::cos(7 * v);
            const double ring = 1 + r * std::cos(u);
            s.vertices.push_back({ring * std::cos(v), ring * std::sin(v), r * std::sin(u)});
            const auto at = [](int ring_index, int sector) {
                return static_cast<std::uint32_t>(ring_index % kRings * kSectors +
                                                  sector % kSectors);
            };
            s.corners.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            s.corners.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
        }
    }
    return s;
}

obb::Pose pose(std::size_t index) {
    const double x = 0.15 * static_cast<double>(index);
    return {obb::Mat3::identity(), {1.0 + x, 0.1 * x, 0.4 - 0.3 * x}};
}

struct Answer {
    std::vector<obb::TrianglePair> pairs;
    double low, high;
    obb::SweepStatus status;
    double first_contact;
    std::uint64_t pops;
    std::vector<double> contacts;
    bool is_inside;
    friend bool operator==(const Answer&, const Answer&) = default;
};

// A turning b comes closer to a, or passes it.
obb::SweepAnswer meet(const obb::TreeView& a, const obb::TreeView& b, std::size_t index) {
    obb::Placement placement{{}, pose(index)};
    placement.b.translation.x += 3;
    const double side = 0.4 * static_cast<double>(index);
    const obb::SweepQuestion question{
        {}, {{-4, side, 0}, {1, 2, 0}, placement.b.translation}, 1, 0};
    const obb::Limits limits;
    obb::SweepRow row(a, b, placement, question, limits, nullptr);
    while (!row.advance()) {
    }
    obb::SweepAnswer answer = row.answer();
    answer.low = answer.status == obb::SweepStatus::kContact ? answer.low : -1;
    return answer;
}

// The times of the first pairs of triangles that meet, in order, while b slides towards a.
std::vector<double> contacts(const obb::TreeView& a, const obb::TreeView& b, std::size_t index) {
    obb::Pose away = pose(index);
    away.translation.x += 3;
    const obb::Screw sliding{{-4, 0, 0}, {}, {}};
    const obb::Limits limits{.distance_tolerance = 1e-6};
    obb::ContactQuery query(
        a, {}, {}, b, away, sliding,
        {.duration = 1, .time_tolerance = 1e-6, .limits = limits, .each_pair = true});
    std::vector<double> times;
    bool is_done = false;
    while (!is_done && times.size() < kContacts) {
        is_done = query.advance(1000);
        while (const auto next = query.take()) {
            times.push_back(next->low);
        }
    }
    times.resize(std::min(times.size(), kContacts));
    return times;
}

// Whether the torus, placed in the world, holds a point of its tube's middle, asked after others.
bool is_inside(const obb::TreeView& a, std::size_t index) {
    obb::ContainmentQuery query(
        a, pose(index),
        {{9, 9, 9}, pose(index).translation, obb::posed(pose(index), obb::Vec3{1, 0, 0})});
    while (!query.advance(100)) {
    }
    return query.inside() == 2;
}

Answer ask(const obb::TreeView& a, const obb::TreeView& b, std::size_t index) {
    obb::StaticQuery all(a, {}, b, pose(index), {.all_pairs = true});
    if (index % 2 == 0) {
        all.advance(50);
        std::vector<obb::StaticQuery> parts = all.divide(6);
        obb::do_parts(parts.size(), 2, [&](std::size_t k) { return parts[k].advance(100); }, [] {});
        all.join(parts);
    }
    while (!all.advance(1000)) {
    }
    obb::DistanceQuery nearest(a, {}, b, pose(index), {});
    while (!nearest.advance(1000)) {
    }
    const obb::DistanceBounds bounds = nearest.bounds();
    const obb::SweepAnswer met = meet(a, b, index);
    return {{all.pairs().begin(), all.pairs().end()},
            bounds.low,
            bounds.high,
            met.status,
            met.low,
            met.counts.pops,
            contacts(a, b, index),
            is_inside(a, index)};
}

// Asks from several threads at once while another one makes the rest of tree a.
template <typename Complete>
int wrong_answers(const obb::TreeView& a, const obb::TreeView& b, const std::vector<Answer>& wanted,
                  Complete complete) {
    std::vector<Answer> answers(kThreads * kPoses);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
        threads.emplace_back([&, t] {
            for (std::size_t i = 0; i < kPoses; ++i) {
                const std::size_t index = (i + 3 * t) % kPoses;
                answers[t * kPoses + index] = ask(a, b, index);
            }
        });
    }
    threads.emplace_back(complete);
    for (std::thread& thread : threads) {
        thread.join();
    }
    int found = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        found += answers[i] == wanted[i % kPoses] ? 0 : 1;
    }
    return found;
}

// A whole tree, written to a file that has no name and opened.
obb::FileTree opened(const obb::TreeBuilder& whole) {
    const obb::TreeView view = whole.view();
    const std::vector<obb::Node> nodes = whole.without_gaps();
    const obb::TreeLayout layout{0, nodes.size(), view.corners.size(), view.vertices.size(),
                                 view.scale_exponent};
    std::vector<std::byte> data(layout.data_bytes());
    std::memcpy(data.data(), nodes.data(), nodes.size() * sizeof(obb::Node));
    std::memcpy(&data[layout.corners_begin()], view.corners.data(), view.corners.size_bytes());
    std::memcpy(&data[layout.ids_begin()], view.triangle_ids.data(),
                view.triangle_ids.size_bytes());
    std::memcpy(&data[layout.vertices_begin()], view.vertices.data(), view.vertices.size_bytes());
    std::vector<std::uint32_t> checksums;
    constexpr std::size_t kBlock = obb::FileBlocks::kBlockBytes;
    for (std::size_t at = 0; at < data.size(); at += kBlock) {
        checksums.push_back(
            obb::crc32(std::span(data).subspan(at, std::min(kBlock, data.size() - at))));
    }
    std::FILE* file = std::tmpfile();
    if (file == nullptr || std::fwrite(data.data(), 1, data.size(), file) != data.size() ||
        std::fflush(file) != 0) {
        std::perror("a temporary file");
        std::abort();
    }
    obb::FileBlocks::Descriptor descriptor(::dup(::fileno(file)));
    std::fclose(file);
    return obb::FileTree(std::move(descriptor), layout, std::move(checksums));
}

int faults(const Surface& s, const obb::BuildOptions& options) {
    obb::TreeBuilder whole(s.vertices, s.corners, options, false, 2);
    while (!whole.advance(1000)) {
    }
    std::vector<Answer> wanted;
    for (std::size_t i = 0; i < kPoses; ++i) {
        wanted.push_back(ask(whole.view(), whole.view(), i));
    }
    int found = 0;
    for (int round = 0; round < kRounds; ++round) {
        obb::TreeBuilder tree_a(s.vertices, s.corners, options, true, 1);
        obb::TreeBuilder tree_b(s.vertices, s.corners, options, true, 2);
        const obb::TreeView a = tree_a.view(), b = tree_b.view();
        found += wrong_answers(a, b, wanted, [&] {
            while (!tree_a.advance(500)) {
            }
        });
        obb::FileTree file_a = opened(whole), file_b = opened(whole);
        found += wrong_answers(file_a.view(), file_b.view(), wanted, [&] { file_a.load_all(); });
    }
    return found;
}

// A query that is divided after any number of pops finds each pair once.
int divided_wrongly(const Surface& s) {
    obb::TreeBuilder whole(s.vertices, s.corners, {}, false, 2);
    while (!whole.advance(1000)) {
    }
    const obb::TreeView tree = whole.view();
    obb::StaticQuery alone(tree, {}, tree, pose(0), {.all_pairs = true});
    while (!alone.advance(1000)) {
    }
    int found = 0;
    for (std::uint64_t pops = 0; pops < 40; ++pops) {
        for (const std::size_t count : {2, 6, 32}) {
            obb::StaticQuery query(tree, {}, tree, pose(0), {.all_pairs = true});
            query.advance(pops);
            std::vector<obb::StaticQuery> parts = query.divide(count);
            for (obb::StaticQuery& part : parts) {
                while (!part.advance(1000)) {
                }
            }
            query.join(parts);
            found += std::ranges::equal(query.pairs(), alone.pairs()) ? 0 : 1;
        }
    }
    return found;
}

} // namespace

int main() {
    const Surface s = bumpy_torus();
    const int wrong = divided_wrongly(s) + faults(s, {}) +
                      faults(s, {.split = obb::Split::kMedian}) +
                      faults(s, {.split = obb::Split::kCenter, .leaf_size = 3});
    std::printf("%d answers differ\n", wrong);
    return wrong == 0 ? 0 : 1;
}
