// Where two bodies move on one screw as seen from each other: which triangles may meet, and when,
// told by their images in coordinates that the screw leaves alone.
#pragma once

#include "descent/bound_queue.hpp"
#include "in_motion/moving_pair.hpp"
#include "screws/image_tree.hpp"
#include "screws/meeting.hpp"
#include "screws/relative_screw.hpp"
#include "tree/tree.hpp"
#include "work/slice.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_set>
#include <vector>

namespace obb {

// Numbers of a pair's two images, where the pair has one each.
struct ImagePair {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t a = kNone, b = kNone;

    [[nodiscard]] bool is_there() const { return a != kNone; }
};

// The common screw of a pair, with slack for points that are near within `near`, scaled; nothing
// where there is none, or where the bodies have too many triangles for images of all.
[[nodiscard]] std::optional<RelativeScrew> common_screw(const MovingPair& pair, double near);

// Times are scaled, as in MovingPair.
class ScrewSearch {
  public:
    // What may meet no earlier than `time`.
    struct Met {
        double time;
        PairRef refs;
        ImagePair images;
    };

    explicit ScrewSearch(const RelativeScrew& screw) : screw_(screw) {}

    // Makes the images of all triangles, for a slice; true when they are made. The pair is known to
    // be apart in [0, start). Throws TreeError where a tree's file is damaged.
    bool make(const MovingPair& pair, double start, SliceClock& clock);
    [[nodiscard]] bool is_made() const { return stage_ == Stage::kMade; }
    // There were too many pieces of triangles, or too many near the axis, where images tell little.
    [[nodiscard]] bool has_failed() const { return stage_ == Stage::kFailed; }

    [[nodiscard]] bool is_empty() const { return queue_.is_empty(); }
    // No pair that was not handed over yet is in contact before this; infinite where none is left.
    [[nodiscard]] double next_time() const { return queue_.next_time(); }
    // Takes the earliest pair of nodes and replaces it by those of their children that may meet
    // before `last`, or hands over the two triangles that are left of it.
    [[nodiscard]] std::optional<Met> advance(double last);
    void clear() { queue_.clear(); }

    // When two images may first meet, at `time` or later; infinite where they do not any more.
    [[nodiscard]] double meeting_time(const ImagePair& images, double time) const;

    // Pairs of nodes or images tested so far.
    [[nodiscard]] std::uint64_t tests() const { return tests_; }

  private:
    enum class Stage : std::uint8_t { kReadA, kReadB, kMakeA, kMakeB, kMade, kFailed };
    struct Entry { // a pair of nodes that is apart before its time
        double time;
        std::uint32_t a, b; // nodes
        std::uint32_t depth;
    };
    // Images of one body while they are being made.
    struct Body {
        std::vector<AxialPoint> points; // of the vertices, those that were needed
        std::vector<Image> images;
        std::uint32_t next = 0; // the first triangle that has none yet
        std::optional<ImageMaker> maker;
    };

    [[nodiscard]] bool read(const MovingTree& body, Stage next, SliceClock& clock);
    [[nodiscard]] bool make_images(const MovingTree& body, Vec3 shift, double extent,
                                   SliceClock& clock);
    void finish(double start);
    [[nodiscard]] bool is_crowded(double start);
    // When a pair may first meet, at its time or later; infinite where it does not.
    [[nodiscard]] double first_time(const Entry& entry);
    [[nodiscard]] bool is_last(const Entry& entry) const; // two single images
    [[nodiscard]] std::array<Entry, 2> split(const Entry& entry);
    void push(Entry entry, double last);
    [[nodiscard]] double sigma_of(double time) const;
    [[nodiscard]] double time_of(double sigma, double least) const;
    [[nodiscard]] std::optional<Met> hand_over(const Entry& entry);

    RelativeScrew screw_;
    Stage stage_ = Stage::kReadA;
    Preparation preparation_;
    bool is_reading_ = false;
    Body made_; // of the body that is being made
    std::array<ImageTree, 2> trees_;
    std::array<bool, 2> by_row_{};
    double duration_ = 0;
    BoundQueue<Entry> queue_;
    std::unordered_set<std::uint64_t> cut_pairs_; // handed over, of triangles that were cut
    std::uint64_t tests_ = 0;
};

} // namespace obb
