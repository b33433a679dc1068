// Many questions about one moving pair across the border.
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
static_assert(kPlacementColumns == 24 && kQuestionColumns == 20 && kAnswerBytes == 232);

// Every row is a part of its own: whichever thread is free takes the next one.
class Sweep {
  public:
    Sweep(const Tree& a, const Tree& b, std::span<const obb::Placement> placements,
          std::span<const obb::SweepQuestion> questions, const obb::SweepOptions& options)
        : a_(a.view), b_(b.view), placements_(placements), questions_(questions), options_(options),
          answers_(questions.size()), running_(questions.size()) {}

    void run(unsigned threads) {
        const SignalWatch watch;
        if (placements_.size() == 1 && questions_.size() > 1) {
            start_.emplace(a_, b_, placements_[0], options_);
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
                                                      questions_[k], options_,
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
    obb::SweepOptions options_;
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
             const Rows<double, kQuestionColumns>& questions, const obb::SweepOptions& options,
             unsigned threads) {
    const auto places = records<obb::Placement>(placements);
    const auto asked = records<obb::SweepQuestion>(questions);
    if (places.size() != 1 && places.size() != asked.size()) {
        throw std::invalid_argument("there must be one placement, or one a question");
    }
    Sweep work(a, b, places, asked, options);
    {
        const nb::gil_scoped_release release;
        work.run(threads);
    }
    const std::size_t count = asked.size();
    return {owned<Owned<std::uint8_t, -1, kAnswerBytes>>(
                std::move(work.answers()), {count, static_cast<std::size_t>(kAnswerBytes)}),
            work.faults()};
}

} // namespace

void bind_sweep(nb::module_& m) {
    nb::class_<obb::SweepOptions>(m, "SweepOptions")
        .def(
            "__init__",
            [](obb::SweepOptions* self, double distance_tolerance, double clearance,
               bool boxes_for_leaves, std::uint32_t max_depth_a, std::uint32_t max_depth_b,
               std::uint64_t max_pops, double seconds) {
                new (self)
                    obb::SweepOptions{distance_tolerance, clearance, boxes_for_leaves, max_depth_a,
                                      max_depth_b,        max_pops,  seconds};
            },
            nb::kw_only(), "distance_tolerance"_a, "clearance"_a, "boxes_for_leaves"_a,
            "max_depth_a"_a, "max_depth_b"_a, "max_pops"_a, "seconds"_a);

    m.def("sweep", &sweep, "a"_a, "b"_a, "placements"_a, "questions"_a, "options"_a, "threads"_a);
}
