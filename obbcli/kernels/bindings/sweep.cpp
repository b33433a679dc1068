// Many questions about one moving pair across the border.
#include "bindings/contact_place.hpp"
#include "bindings/module.hpp"

#include "in_motion/contact_sweep.hpp"
#include "work/parallel.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>

using namespace nb::literals;

namespace {

constexpr nb::ssize_t kPlacementColumns = sizeof(obb::Placement) / sizeof(double);
constexpr nb::ssize_t kQuestionColumns = sizeof(obb::SweepQuestion) / sizeof(double);
constexpr nb::ssize_t kAnswerBytes = sizeof(obb::SweepAnswer);
static_assert(kPlacementColumns == 24 && kQuestionColumns == 20); // as batch.py fills them

// Every row is a part of its own: whichever thread is free takes the next one.
class Sweep {
  public:
    Sweep(const Tree& a, const Tree& b, std::span<const obb::Placement> placements,
          std::span<const obb::SweepQuestion> questions, const obb::Limits& limits)
        : a_(a.view), b_(b.view), placements_(placements), questions_(questions), limits_(limits),
          answers_(questions.size()), running_(questions.size()) {}

    void run(unsigned threads) {
        const SignalWatch watch;
        if (placements_.size() == 1 && questions_.size() > 1) {
            start_.emplace(a_, b_, placements_[0], limits_);
            while (!start_->advance()) {
                watch();
            }
        }
        obb::do_parts(questions_.size(), threads, [&](std::size_t k) { return advance(k); }, watch);
        std::sort(faults_.begin(), faults_.end());
    }

    [[nodiscard]] std::vector<obb::SweepAnswer>& answers() { return answers_; }
    // Row, whether the pose is at fault and not the motion, and what is wrong.
    [[nodiscard]] const std::vector<std::tuple<std::size_t, bool, std::string>>& faults() const {
        return faults_;
    }

  private:
    bool advance(std::size_t k) {
        std::unique_ptr<obb::SweepRow>& row = running_[k];
        try {
            if (row == nullptr) {
                row = std::make_unique<obb::SweepRow>(a_, b_, placements_[start_ ? 0 : k],
                                                      questions_[k], limits_,
                                                      start_ ? &*start_ : nullptr);
            }
            if (!row->advance()) {
                return false;
            }
            answers_[k] = row->answer();
        } catch (const std::domain_error& fault) {
            answers_[k].status = obb::SweepStatus::kRefused;
            const std::lock_guard lock(mutex_);
            faults_.emplace_back(k, row == nullptr, fault.what());
        }
        row.reset();
        return true;
    }

    const obb::TreeView &a_, &b_;
    std::span<const obb::Placement> placements_;
    std::span<const obb::SweepQuestion> questions_;
    obb::Limits limits_;
    std::optional<obb::SweepStart> start_;
    std::vector<obb::SweepAnswer> answers_;
    std::vector<std::unique_ptr<obb::SweepRow>> running_;
    std::mutex mutex_;
    std::vector<std::tuple<std::size_t, bool, std::string>> faults_;
};

// The rows as bytes, and the faults of those that were refused
using Result = std::tuple<Owned<std::uint8_t, -1, kAnswerBytes>,
                          std::vector<std::tuple<std::size_t, bool, std::string>>>;

Result sweep(const Tree& a, const Tree& b, const Rows<double, kPlacementColumns>& placements,
             const Rows<double, kQuestionColumns>& questions, const obb::Limits& limits,
             unsigned threads) {
    const auto places = records<obb::Placement>(placements);
    const auto asked = records<obb::SweepQuestion>(questions);
    if (places.size() != 1 && places.size() != asked.size()) {
        throw std::invalid_argument("there must be one placement, or one a question");
    }
    Sweep work(a, b, places, asked, limits);
    {
        const nb::gil_scoped_release release;
        work.run(threads);
    }
    const std::size_t count = asked.size();
    return {owned<Owned<std::uint8_t, -1, kAnswerBytes>>(
                std::move(work.answers()), {count, static_cast<std::size_t>(kAnswerBytes)}),
            work.faults()};
}

// Columns of an answer: names, formats of NumPy, and at which bytes of a row.
using Columns = std::vector<std::tuple<std::string, std::string, std::size_t>>;

const char* format_of(double) { return "f8"; }
const char* format_of(const obb::Vec3&) { return "3f8"; }
const char* format_of(std::int64_t) { return "i8"; }
const char* format_of(std::uint64_t) { return "u8"; }
const char* format_of(bool) { return "?"; }
const char* format_of(std::uint8_t) { return "u1"; } // codes
const char* format_of(obb::Evidence) { return "u1"; }
const char* format_of(obb::SweepStatus) { return "u1"; }

Columns answer_columns() {
    const obb::SweepAnswer row;
    Columns columns;
    const auto tell = [&](const char* name, const auto& value) {
        const auto offset =
            reinterpret_cast<const char*>(&value) - reinterpret_cast<const char*>(&row);
        columns.emplace_back(name, format_of(value), static_cast<std::size_t>(offset));
    };
    tell("status", row.status);
    tell("time_lo", row.low);
    tell("time_hi", row.high);
    tell("evidence", row.evidence);
    each_place_field([&](const char* name, auto member) { tell(name, row.place.*member); });
    tell("triangle_a", row.triangle_a);
    tell("triangle_b", row.triangle_b);
    tell("distance", row.distance);
    tell("error_bound", row.error_bound);
    tell("approximate", row.approximate);
    tell("box_tests", row.counts.box_tests);
    tell("triangle_tests", row.counts.triangle_tests);
    tell("exact_triangle_tests", row.counts.exact_triangle_tests);
    tell("pops", row.counts.pops);
    tell("image_tests", row.counts.image_tests);
    return columns;
}

} // namespace

void bind_sweep(nb::module_& m) {
    m.def("sweep_columns", [] { return std::tuple{answer_columns(), sizeof(obb::SweepAnswer)}; });
    m.def("sweep", &sweep, "a"_a, "b"_a, "placements"_a, "questions"_a, "limits"_a, "threads"_a);
}
