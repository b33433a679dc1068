// The data of a tree file as an attacker may give them: with checksums that fit, and damaged under
// checksums of the undamaged. Bytes: see `take_file`; `seeds.py` writes them from real files.
#include "at_rest/static_query.hpp"
#include "bytes.hpp"
#include "distance/distance_query.hpp"
#include "in_motion/contact_sweep.hpp"
#include "tree/crc32.hpp"
#include "tree/file_tree.hpp"
#include "tree/tree_check.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>

namespace {

using fuzz::require;

constexpr std::uint64_t kMostPops = 2000;

struct File {
    obb::TreeLayout layout;
    std::vector<std::uint8_t> data, damaged;
    std::uint32_t leaf_size;
    obb::Pose pose;
    obb::Screw screw;
};

// One byte of leaf size, two of exponent, three of counts, how many bytes are damaged, and by what;
// pose and motion of the other body; then the sections as they stand in a file.
File take_file(fuzz::Bytes& bytes) {
    File file{};
    file.leaf_size = 1 + bytes.below(4);
    file.layout.scale_exponent = bytes.take<std::int16_t>() % 1101;
    file.layout.triangle_count = 1 + bytes.below(48);
    const auto most = static_cast<std::uint32_t>(file.layout.triangle_count - 1);
    file.layout.node_count = most == 0 ? 0 : 1 + bytes.take<std::uint8_t>() % most;
    file.layout.vertex_count = bytes.take<std::uint8_t>();
    std::vector<std::pair<std::uint16_t, std::uint8_t>> damages(bytes.below(4));
    for (auto& [place, change] : damages) {
        place = bytes.take<std::uint16_t>();
        change = bytes.take<std::uint8_t>();
    }
    file.pose = bytes.pose();
    file.screw = bytes.screw();
    file.data.resize(file.layout.data_bytes());
    std::copy_n(bytes.rest().begin(), std::min(bytes.rest().size(), file.data.size()),
                file.data.begin());
    file.damaged = file.data;
    for (const auto& [place, change] : damages) {
        file.damaged[place % file.damaged.size()] ^= change;
    }
    return file;
}

obb::FileBlocks::Descriptor in_memory(std::span<const std::uint8_t> data) {
    const int number = ::memfd_create("tree", 0);
    require(number >= 0 &&
                ::write(number, data.data(), data.size()) == static_cast<::ssize_t>(data.size()),
            "a file can be had");
    return obb::FileBlocks::Descriptor(number);
}

std::vector<std::uint32_t> checksums_of(std::span<const std::uint8_t> data) {
    std::vector<std::uint32_t> checksums;
    for (std::size_t at = 0; at < data.size(); at += obb::FileBlocks::kBlockBytes) {
        const auto rest = std::as_bytes(data.subspan(at));
        checksums.push_back(
            obb::crc32(rest.first(std::min(obb::FileBlocks::kBlockBytes, rest.size()))));
    }
    return checksums;
}

struct Answer {
    bool is_refused = false; // the tree is at fault
    bool is_beyond = false;  // numbers leave the range of double
    std::optional<std::string> fault;
    std::vector<obb::TrianglePair> pairs;
    std::vector<double> numbers;
    friend bool operator==(const Answer&, const Answer&) = default;
};

constexpr int kQuestions = 4;

// One question to a file just opened.
Answer ask(const File& file, std::span<const std::uint8_t> data,
           std::vector<std::uint32_t> checksums, int question) {
    Answer answer;
    try {
        obb::FileTree tree(in_memory(data), file.layout, std::move(checksums));
        const obb::TreeView view = tree.view();
        if (question == 0) {
            tree.load_all();
            answer.fault = obb::tree_check(view, file.leaf_size, ~0U);
            answer.numbers.push_back(static_cast<double>(obb::tree_levels(view).size()));
        } else if (question == 1) {
            obb::StaticQuery query(view, {}, view, file.pose, {.all_pairs = true});
            while (!query.advance(kMostPops)) {
            }
            answer.pairs.assign(query.pairs().begin(), query.pairs().end());
        } else if (question == 2) {
            obb::DistanceQuery query(view, {}, view, file.pose, {});
            while (query.counts().pops < kMostPops &&
                   !query.advance(kMostPops - query.counts().pops)) {
            }
            const obb::DistanceBounds bounds = query.bounds();
            require(bounds.low <= bounds.high, "bounds of a distance are in order");
            answer.numbers = {bounds.low, bounds.high};
        } else {
            const obb::Placement placement{{}, file.pose};
            const obb::SweepQuestion asked{{}, file.screw, 1, 1e-9};
            const obb::Limits limits{.max_pops = kMostPops};
            obb::SweepRow row(view, view, placement, asked, limits, nullptr);
            while (!row.advance()) {
            }
            const obb::SweepAnswer& found = row.answer();
            require(found.counts.pops <= kMostPops, "a question ends at its limit");
            answer.numbers = {static_cast<double>(found.status),
                              std::isnan(found.low) ? -1 : found.low};
        }
    } catch (const obb::TreeError&) {
        answer = {};
        answer.is_refused = true;
    } catch (const std::domain_error&) {
        answer = {};
        answer.is_beyond = true;
    }
    return answer;
}

// A tree that is proven sound says what every pair of its triangles says.
void check_pairs(const File& file, const Answer& answer) {
    obb::FileTree tree(in_memory(file.data), file.layout, {});
    tree.load_all();
    const obb::TreeView view = tree.view();
    std::vector<obb::TrianglePair> wanted;
    for (std::uint32_t i = 0; i < view.triangle_count(); ++i) {
        for (std::uint32_t j = 0; j < view.triangle_count(); ++j) {
            const obb::Triangle other = file.pose.is_identity()
                                            ? view.triangle(j)
                                            : obb::posed(file.pose, view.triangle(j));
            if (obb::triangles_intersect(view.triangle(i), other)) {
                wanted.push_back({view.triangle_ids[i], view.triangle_ids[j]});
            }
        }
    }
    std::sort(wanted.begin(), wanted.end());
    require(answer.pairs == wanted, "a sound tree finds the pairs that there are");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    const File file = take_file(bytes);
    const std::vector<std::uint32_t> checksums = checksums_of(file.data);
    bool is_sound = false;
    for (int question = 0; question < kQuestions; ++question) {
        const Answer answer = ask(file, file.data, checksums, question);
        is_sound = is_sound || (question == 0 && !answer.is_refused && !answer.fault);
        require(!is_sound || !answer.is_refused, "a sound tree is not refused");
        if (question == 1 && is_sound && !answer.is_beyond) {
            check_pairs(file, answer);
        }
        if (file.damaged != file.data) {
            const Answer verified = ask(file, file.damaged, checksums, question);
            require(verified.is_refused || verified == answer,
                    "damage is refused or changes nothing");
            static_cast<void>(ask(file, file.damaged, {}, question));
        }
    }
    return 0;
}
