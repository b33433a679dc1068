// Work cut into parts, done by several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace obb {

// Does the parts 0 to count - 1 in at most so many threads, this one among them. part(k) does a
// slice of one, some milliseconds at most, and returns whether that was the last; which thread does
// it, and when, is chance. Between slices this thread calls pause(), also while it waits for the
// others. What either throws ends all work and is thrown here.
template <typename Part, typename Pause>
void do_parts(std::size_t count, unsigned threads, const Part& part, const Pause& pause) {
    constexpr auto kWait = std::chrono::milliseconds(20);
    std::atomic<std::size_t> next{0};
    std::atomic<bool> is_over{false};
    std::mutex mutex;
    std::condition_variable ended;
    std::size_t running = 0;
    std::exception_ptr fault;

    const auto guarded = [&](const auto& work) {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex);
            fault = fault ? fault : std::current_exception();
            is_over = true;
        }
    };
    const auto run = [&](const auto& between) {
        for (std::size_t k = next++; k < count; k = next++) {
            for (bool is_done = false; !is_done;) {
                if (is_over) {
                    return;
                }
                is_done = part(k);
                between();
            }
        }
    };
    const auto helper = [&] {
        guarded([&] { run([] {}); });
        const std::lock_guard lock(mutex);
        --running;
        ended.notify_one();
    };

    std::vector<std::thread> others;
    guarded([&] {
        const std::size_t wanted = std::min<std::size_t>(std::max(threads, 1U), count);
        others.reserve(wanted);
        while (others.size() + 1 < wanted) {
            const std::lock_guard lock(mutex);
            try {
                others.emplace_back(helper);
            } catch (const std::system_error&) {
                break; // the system gives no more threads: those that are there do it all
            }
            ++running;
        }
        run(pause);
        std::unique_lock lock(mutex);
        while (!ended.wait_for(lock, kWait, [&] { return running == 0; })) {
            lock.unlock();
            pause();
            lock.lock();
        }
    });
    for (std::thread& other : others) {
        other.join();
    }
    if (fault) {
        std::rethrow_exception(fault);
    }
}

} // namespace obb
