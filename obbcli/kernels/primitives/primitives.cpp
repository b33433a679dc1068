#include "primitives/primitives.hpp"

#include "work/parallel.hpp"

#include <algorithm>

namespace obb {
namespace {

// Chunks of pairs, each less than some milliseconds of work: pair by pair into verdicts or lists.
constexpr std::size_t kPairsAChunk = 512;

[[nodiscard]] std::size_t chunk_count(std::size_t count) {
    return (count + kPairsAChunk - 1) / kPairsAChunk;
}

// Calls work(chunk, begin, end) for each chunk of [0, count).
template <typename Work>
void in_chunks(std::size_t count, const Crew& crew, const Work& work) {
    // A thread costs more than it saves where it gets fewer.
    constexpr std::size_t kChunksAThread = 4;
    const std::size_t chunks = chunk_count(count);
    const std::size_t useful = std::max<std::size_t>(1, chunks / kChunksAThread);
    const auto one = [&](std::size_t chunk) {
        const std::size_t begin = chunk * kPairsAChunk;
        work(chunk, begin, std::min(begin + kPairsAChunk, count));
        return true;
    };
    do_parts(chunks, static_cast<unsigned>(std::min<std::size_t>(crew.threads, useful)), one,
             crew.pause);
}

} // namespace

template <typename A, typename B>
void test_pairs(Repeated<A> a, Repeated<B> b, const RepeatedMotion& motion, const Crew& crew,
                std::span<std::uint8_t> verdicts) {
    in_chunks(verdicts.size(), crew, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const PairVerdict verdict = test_pair(a[k], b[k], motion[k]);
            verdicts[k] = static_cast<std::uint8_t>((verdict.intersects ? kMeets : 0) |
                                                    (verdict.exact ? kExact : 0));
        }
    });
}

template <typename A, typename B>
PairContacts first_contacts(Repeated<A> a, Repeated<B> b, const RepeatedMotion& motion,
                            std::size_t count, const Crew& crew) {
    std::vector<PairContacts> found(chunk_count(count));
    in_chunks(count, crew, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            if (const auto contact = first_contact(a[k], b[k], motion[k])) {
                found[chunk].rows.push_back(static_cast<std::int64_t>(k));
                found[chunk].contacts.push_back(*contact);
            }
        }
    });
    PairContacts all;
    for (const PairContacts& some : found) {
        all.rows.insert(all.rows.end(), some.rows.begin(), some.rows.end());
        all.contacts.insert(all.contacts.end(), some.contacts.begin(), some.contacts.end());
    }
    return all;
}

template void test_pairs(Repeated<Triangle>, Repeated<Triangle>, const RepeatedMotion&, const Crew&,
                         std::span<std::uint8_t>);
template void test_pairs(Repeated<Triangle>, Repeated<Obb>, const RepeatedMotion&, const Crew&,
                         std::span<std::uint8_t>);
template void test_pairs(Repeated<Obb>, Repeated<Triangle>, const RepeatedMotion&, const Crew&,
                         std::span<std::uint8_t>);
template void test_pairs(Repeated<Obb>, Repeated<Obb>, const RepeatedMotion&, const Crew&,
                         std::span<std::uint8_t>);

template PairContacts first_contacts(Repeated<Triangle>, Repeated<Triangle>, const RepeatedMotion&,
                                     std::size_t, const Crew&);
template PairContacts first_contacts(Repeated<Triangle>, Repeated<Obb>, const RepeatedMotion&,
                                     std::size_t, const Crew&);
template PairContacts first_contacts(Repeated<Obb>, Repeated<Triangle>, const RepeatedMotion&,
                                     std::size_t, const Crew&);
template PairContacts first_contacts(Repeated<Obb>, Repeated<Obb>, const RepeatedMotion&,
                                     std::size_t, const Crew&);

} // namespace obb
