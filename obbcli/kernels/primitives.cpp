#include "primitives.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace obb {
namespace {

// Threads that are joined whatever happens.
class Workers {
  public:
    Workers() = default;
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;
    ~Workers() {
        for (std::thread& thread : threads_) {
            thread.join();
        }
    }
    template <typename Work>
    void start(Work&& work) {
        threads_.emplace_back(std::forward<Work>(work));
    }

  private:
    std::vector<std::thread> threads_;
};

// Splits [0, count) into ranges and calls work(part, begin, end) for each, on a thread of its own.
template <typename Work>
void in_parts(std::size_t count, unsigned parts, const Work& work) {
    const auto run = [&](std::size_t part) {
        work(part, count * part / parts, count * (part + 1) / parts);
    };
    Workers workers;
    for (std::size_t part = 1; part < parts; ++part) {
        workers.start([&run, part] { run(part); });
    }
    run(0);
}

[[nodiscard]] unsigned part_count(std::size_t count, unsigned threads) {
    // Below this many pairs a thread costs more than it saves.
    constexpr std::size_t kPairsPerThread = 1000;
    const std::size_t useful = std::max<std::size_t>(1, count / kPairsPerThread);
    return static_cast<unsigned>(std::clamp<std::size_t>(threads, 1, useful));
}

} // namespace

template <typename A, typename B>
void test_pairs(Repeated<A> a, Repeated<B> b, const RepeatedMotion& motion, unsigned threads,
                std::span<std::uint8_t> verdicts) {
    const std::size_t count = verdicts.size();
    in_parts(count, part_count(count, threads),
             [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                     const PairVerdict verdict = test_pair(a[k], b[k], motion[k]);
                     verdicts[k] = static_cast<std::uint8_t>((verdict.intersects ? kMeets : 0) |
                                                             (verdict.exact ? kExact : 0));
                 }
             });
}

template <typename A, typename B>
PairContacts first_contacts(Repeated<A> a, Repeated<B> b, const RepeatedMotion& motion,
                            std::size_t count, unsigned threads) {
    const unsigned parts = part_count(count, threads);
    std::vector<PairContacts> found(parts);
    in_parts(count, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            if (const auto contact = first_contact(a[k], b[k], motion[k])) {
                found[part].rows.push_back(static_cast<std::int64_t>(k));
                found[part].contacts.push_back(*contact);
            }
        }
    });
    PairContacts all = std::move(found[0]);
    for (std::size_t part = 1; part < parts; ++part) {
        all.rows.insert(all.rows.end(), found[part].rows.begin(), found[part].rows.end());
        all.contacts.insert(all.contacts.end(), found[part].contacts.begin(),
                            found[part].contacts.end());
    }
    return all;
}

template void test_pairs(Repeated<Triangle>, Repeated<Triangle>, const RepeatedMotion&, unsigned,
                         std::span<std::uint8_t>);
template void test_pairs(Repeated<Triangle>, Repeated<Obb>, const RepeatedMotion&, unsigned,
                         std::span<std::uint8_t>);
template void test_pairs(Repeated<Obb>, Repeated<Triangle>, const RepeatedMotion&, unsigned,
                         std::span<std::uint8_t>);
template void test_pairs(Repeated<Obb>, Repeated<Obb>, const RepeatedMotion&, unsigned,
                         std::span<std::uint8_t>);

template PairContacts first_contacts(Repeated<Triangle>, Repeated<Triangle>, const RepeatedMotion&,
                                     std::size_t, unsigned);
template PairContacts first_contacts(Repeated<Triangle>, Repeated<Obb>, const RepeatedMotion&,
                                     std::size_t, unsigned);
template PairContacts first_contacts(Repeated<Obb>, Repeated<Triangle>, const RepeatedMotion&,
                                     std::size_t, unsigned);
template PairContacts first_contacts(Repeated<Obb>, Repeated<Obb>, const RepeatedMotion&,
                                     std::size_t, unsigned);

} // namespace obb
